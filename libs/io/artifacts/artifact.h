// SPDX-License-Identifier: GPL-3.0-or-later
// Artifacts: results that a run keeps, so that a later run takes them again instead of making the
// same ones anew. The mark of an artifact says from what it was made. A file of arrays contains its
// mark (array_file.h), a depth map has it in its side file (io/openmvs/dmap.h), another file has it
// in a side file of the form below, and a folder in its file made-from.json.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"

namespace axial::io {

struct Artifact {
  std::filesystem::path file;  // a file or a folder
  // Identifies all that decides on the content: method, inputs and options. If the text differs,
  // the artifact counts as missing.
  std::string made_from;
  std::string kind = {};  // of a file of arrays: names the content and the version of the format
};

// The side file of `file`: the same name with ".json" added.
std::filesystem::path side_file(const std::filesystem::path& file);

// `file` and its side file.
std::vector<std::filesystem::path> with_side_file(const std::filesystem::path& file);

// Removes `file` and its side file, if they exist. Failures are ignored.
void remove_with_side_file(const std::filesystem::path& file);

// Writes the side file of a file that is complete: `facts` about it, which are the caller's, and
// the entries "version", "made_from" and "content", the print_of_file(). Error if it cannot be
// written.
void write_mark(const Artifact& artifact, nlohmann::json facts);

// Returns the content of the side file that write_mark() wrote for the artifact. Returns nothing if
// the file or its side file is missing or damaged, if the file has changed since then, or if it was
// made from something else.
std::optional<nlohmann::json> read_mark(const Artifact& artifact);

// The same whatever the file was made from.
std::optional<nlohmann::json> read_mark(const std::filesystem::path& file);

// Fills a folder by make(), unless an earlier call, perhaps of another run, has filled it from the
// same. When make() is called, the folder exists and is empty. If make() throws, the exception is
// passed on, the folder does not count as filled, and the next call removes its content.
void fill_folder(const Artifact& folder, const std::function<void()>& make);

// A fingerprint of the bytes of a file, which is read in pieces. Error that names the file if it is
// not a regular file or cannot be read.
std::string print_of_file(const std::filesystem::path& file);

// Adds the size of a file and its time of change to `print`, for files that are too large to be
// read in each run. Returns false, and adds nothing, if there is no such file.
bool add_state(Fingerprint& print, const std::filesystem::path& file);

}  // namespace axial::io
