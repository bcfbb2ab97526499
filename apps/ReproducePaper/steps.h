// SPDX-License-Identifier: GPL-3.0-or-later
// What all steps of a chain are made of.
#pragma once

#include "base/atomic_file.h"
#include "chain.h"
#include "io/json.h"

namespace axial {

Words& operator+=(Words& words, const Words& more);

// `folder` as `make` fills it, unless it was made from the same `inputs` before.
template <class Make>
void step(const std::filesystem::path& folder, const Json& inputs, Make make) {
  const std::filesystem::path mark = folder / "made-from.json";
  if (std::filesystem::is_regular_file(mark) && read_file(mark) == io::to_text(inputs)) return;
  std::filesystem::remove_all(folder);
  make_folder(folder);
  make();
  write_atomically(mark, io::to_text(inputs));
}

// One of the project's programs. False: it said one of `excuses`, see run_unless_excused.
bool run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const std::filesystem::path& log, const Words& excuses = {});

// CPU time of all programs that this one has run to their end [s].
double children_seconds();

std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder,
                                                   const std::string& end);

// Names and bytes of a file, or of all files of a folder, in a few digits.
std::string content_of(const std::filesystem::path& file_or_folder);

// The same of some of the project's programs: what they made is made anew by other ones.
Json content_of_programs(const Words& programs);

}  // namespace axial
