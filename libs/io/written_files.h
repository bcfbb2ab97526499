// SPDX-License-Identifier: GPL-3.0-or-later
// What a program wrote into a folder: a list with fingerprints of the contents, so that the next
// run removes what it does not replace, and nothing that others wrote or changed.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace axial::io {

// All files below `folder`, at any depth, but no links: { "path/below/it": fingerprint, ... }.
nlohmann::json list_files(const std::filesystem::path& folder);

struct WrittenFiles {
  std::vector<std::filesystem::path> unchanged;  // paths below the folder, sorted
  std::vector<std::filesystem::path> changed;    // are there, with another content
};

// Which of `listed`, as list_files made it, are in `folder` today. Entries that list_files does not
// make, such as paths that lead out of the folder, are passed over.
WrittenFiles find_written(const std::filesystem::path& folder, const nlohmann::json& listed);

// Removes files below `folder`, and the folders below it that are empty then.
void remove_below(const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& files);

}  // namespace axial::io
