// SPDX-License-Identifier: GPL-3.0-or-later
// An experiment's numbers in a folder: finished parts are found there again.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "experiments/experiment.h"

namespace axial {

// Those whose names begin with `beginning`.
std::vector<experiments::Part> chosen_parts(const experiments::Experiment& experiment,
                                            const std::string& beginning);

// Computes those of `parts` that `folder`/parts/<experiment> does not hold yet, each written there
// as soon as it is finished, and beside it how long it took. A part counts as finished if its file
// is whole and names the same inputs.
void compute(const std::string& experiment, const std::vector<experiments::Part>& parts,
             const std::filesystem::path& folder, const ProgressSink& progress);

// All that is kept; null unless all parts are finished.
experiments::Json kept_results(const experiments::Experiment& experiment, bool quick,
                               const std::filesystem::path& folder);

// What the parts that are finished took, on whatever machine that was [s].
struct PartTimes {
  std::size_t parts = 0;  // whose time is known
  double sum = 0, longest = 0;
  std::string longest_part;
};
PartTimes part_times(const experiments::Experiment& experiment,
                     const std::filesystem::path& folder);

}  // namespace axial
