// SPDX-License-Identifier: GPL-3.0-or-later
// Building blocks of the chain's steps.
#pragma once

#include "base/atomic_file.h"
#include "chain.h"
#include "io/bytes/json.h"

namespace axial {

Words& operator+=(Words& words, const Words& more);

// Fills `folder` with `make`, unless the folder was made with the same `inputs` before.
template <class Make>
void step(const std::filesystem::path& folder, const Json& inputs, Make make) {
  const std::filesystem::path mark = folder / "made-from.json";
  if (std::filesystem::is_regular_file(mark) && read_file(mark) == io::to_text(inputs)) return;
  std::filesystem::remove_all(folder);
  make_folder(folder);
  make();
  write_atomically(mark, io::to_text(inputs));
}

// Runs one of the project's programs. Returns false if its error is one of `excuses`
// (run_unless_excused).
bool run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const std::filesystem::path& log, const Words& excuses = {});

// CPU time [s] of all child processes that have ended.
double children_seconds();

std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder,
                                                   const std::string& end);

// A fingerprint of the name and bytes of a file, or of all files of a folder.
std::string content_of(const std::filesystem::path& file_or_folder);

// Fingerprints of some of the project's programs. As inputs of a step they make sure that the step
// is repeated with changed programs.
Json content_of_programs(const Words& programs);

}  // namespace axial
