// SPDX-License-Identifier: GPL-3.0-or-later
// Building blocks of the chain's steps (chain.h).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "experiments/experiment.h"
#include "io/artifacts/artifact.h"
#include "io/bytes/json.h"

namespace axial::experiments {

using Words = std::vector<std::string>;  // words of a command line

struct Chain {
  std::filesystem::path work;  // the folder that contains the folders of the steps
  unsigned max_threads = 0;    // number of threads of each program; 0: all cores
};

// Appends `more` to `words`. Returns `words`.
Words& operator+=(Words& words, const Words& more);

// Fills `folder` by make(), unless it was filled with the same `inputs` (io::fill_folder()).
inline void step(const std::filesystem::path& folder, const Json& inputs,
                 const std::function<void()>& make) {
  io::fill_folder({folder, io::to_text(inputs)}, make);
}

// Runs one of the project's programs with `chain.max_threads`. `program`: its name; it lies beside
// the running program. The output of the program goes to the file `log`. Returns true if the
// program ends with exit code 0. Returns false if the program ends with exit code 1 and its output
// contains one of the texts `excuses`. Otherwise throws an Error that names the program and the
// log.
bool run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const std::filesystem::path& log, const Words& excuses = {});

// Returns the CPU time [s] of all child processes of this process that have ended so far.
double children_seconds();

// Returns the paths of the entries of a folder whose names end in the text `end`, in the order of
// their names. If `end` is empty: of all entries. Precondition: the folder exists.
std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder,
                                                   const std::string& end);

// Returns a fingerprint of the name and bytes of a file, or of the names and bytes of all files of
// a folder. Precondition: the folder contains only files. Error if a file cannot be read.
std::string content_of(const std::filesystem::path& file_or_folder);

// Returns an object with the fingerprint of each of `programs`, which are names of the project's
// programs. If the inputs of a step contain the fingerprints, the step is repeated when a program
// changes. Error if a program does not lie beside the running program.
Json content_of_programs(const Words& programs);

}  // namespace axial::experiments
