// SPDX-License-Identifier: GPL-3.0-or-later
// Building blocks of the chain's steps (chain.h).
#pragma once

#include "base/atomic_file.h"
#include "experiments/chain.h"
#include "io/bytes/json.h"

namespace axial::experiments {

// Appends `more`.
Words& operator+=(Words& words, const Words& more);

// Fills `folder` with `make`, unless the folder was made with the same `inputs` before. `make` gets
// an empty folder. If `make` throws, the folder counts as not made: what `make` left there is
// removed at the next call.
template <class Make>
void step(const std::filesystem::path& folder, const Json& inputs, Make make) {
  const std::filesystem::path mark = folder / "made-from.json";
  if (std::filesystem::is_regular_file(mark) && read_file(mark) == io::to_text(inputs)) return;
  std::filesystem::remove_all(folder);
  make_folder(folder);
  make();
  write_atomically(mark, io::to_text(inputs));
}

// Runs one of the project's programs, which lies beside the running program, with `max_threads` of
// the chain. Its output goes to the file `log`. Returns false if its error is one of `excuses`
// (run_unless_excused). Any other error of the program is an Error.
bool run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const std::filesystem::path& log, const Words& excuses = {});

// CPU time [s] of all child processes that have ended.
double children_seconds();

// The files of a folder whose paths end in `end`, in the order of names.
std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder,
                                                   const std::string& end);

// A fingerprint of the name and bytes of a file, or of all files of a folder that has no folders in
// it. Error if a file cannot be read.
std::string content_of(const std::filesystem::path& file_or_folder);

// Fingerprints of some of the project's programs. As inputs of a step they make sure that the step
// is repeated with changed programs. Error if a program does not lie beside the running program.
Json content_of_programs(const Words& programs);

}  // namespace axial::experiments
