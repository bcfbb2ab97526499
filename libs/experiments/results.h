// SPDX-License-Identifier: GPL-3.0-or-later
// Stores an experiment's numbers in a folder, and finds finished parts there again.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "experiments/experiment.h"

namespace axial::experiments {

// The parts whose names begin with `beginning`.
std::vector<Part> chosen_parts(const Experiment& experiment, const std::string& beginning);

// Computes the parts that `folder`/parts/<experiment> does not hold yet. Writes each part there as
// soon as it is finished, and its computation time beside it. A part counts as finished if its file
// is complete and has the same inputs. `progress` gets the number of finished parts. If a part
// throws, the parts before it stay finished, and the function throws the same. Error that names a
// folder or file that cannot be written.
void compute(const std::string& experiment, const std::vector<Part>& parts,
             const std::filesystem::path& folder, const ProgressSink& progress);

// All stored results, in the form that Experiment::documents takes, with "experiment" and "quick";
// null unless all parts are finished.
Json kept_results(const Experiment& experiment, bool quick, const std::filesystem::path& folder);

// Computation times [s] of the finished parts, on the machines that computed them.
struct PartTimes {
  std::size_t parts = 0;  // number of parts with a known time
  double sum = 0, longest = 0;
  std::string longest_part;
};
PartTimes part_times(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace axial::experiments
