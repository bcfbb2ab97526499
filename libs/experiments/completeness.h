// SPDX-License-Identifier: GPL-3.0-or-later
// Completeness of clouds by the number of cameras that see a place: simulates, reconstructs and
// measures scenes of one preset in one command.
#pragma once

#include <string>
#include <vector>

#include "experiments/chain.h"
#include "experiments/experiment.h"

namespace axial::experiments {

struct CompletenessOptions {
  std::string preset = "closeup";      // of SimulateUnderwater
  std::string medium = "water";        // "air" or "water"
  std::string poses = "true";          // "true", or "colmap": computed from photographs in air
  std::vector<int> seeds{11, 12, 13};  // seeds of the scenes: at least one, each only once
  // The tolerance of the evaluation [m]. 0: 2 mm for presets whose name starts with "closeup" or
  // "thicket", otherwise 5 mm.
  double tolerance = 0;
  Words scene, dense;  // more options of SimulateUnderwater and of DensifyPointCloud
};

// The name of the experiment: "completeness_closeup_water_true".
std::string completeness_name(const CompletenessOptions& options);

// Returns the experiment. It has one part for each seed. The result of a part is the report of
// EvaluateReconstruction without histograms, and "cpu_seconds", the CPU time of DensifyPointCloud
// [s]. `chain.work` keeps the scenes and clouds. Errors as for the experiments in chained.h.
// Precondition: every field of `options` has a value that its comment allows.
Experiment completeness(const Chain& chain, const CompletenessOptions& options);

// Returns one document, <completeness_name(options)>.md, with one row for each seed and a row of
// medians. `results`: results of the experiment with the same options. A number that a seed does
// not have is "-" and does not count for the median. Precondition as for completeness().
std::vector<Document> completeness_documents(const CompletenessOptions& options,
                                             const Json& results);

}  // namespace axial::experiments
