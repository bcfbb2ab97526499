// SPDX-License-Identifier: GPL-3.0-or-later
// Stores the results of an experiment in a folder, and finds finished parts in this folder.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "experiments/experiment.h"

namespace axial::experiments {

// Returns the parts of the experiment whose names begin with `beginning`.
std::vector<Part> chosen_parts(const Experiment& experiment, const std::string& beginning);

// Computes those of `parts` that are not finished. A part is finished if
// `folder`/parts/<experiment> holds a complete file of the part with the same inputs. Writes the
// file of each part as soon as the part is computed, and the computation time into a second file
// beside it. `progress` gets the number of finished parts. If the computation of a part throws an
// exception, the exception is passed on, and the parts before it stay finished. Error that names
// the folder or file if it cannot be written.
void compute(const std::string& experiment, const std::vector<Part>& parts,
             const std::filesystem::path& folder, const ProgressSink& progress);

// Returns all stored results in the form that Experiment::documents takes. Returns null unless all
// parts of the experiment are finished (compute()).
Json kept_results(const Experiment& experiment, bool quick, const std::filesystem::path& folder);

// Wall-clock times [s] of the computations of the parts, on the machines that computed the parts.
struct PartTimes {
  std::size_t parts = 0;        // number of parts with a known time
  double sum = 0, longest = 0;  // over these parts [s]
  std::string longest_part;
};
PartTimes part_times(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace axial::experiments
