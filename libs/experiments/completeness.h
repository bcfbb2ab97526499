// SPDX-License-Identifier: GPL-3.0-or-later
// Completeness of clouds by the number of cameras that see a place of the true surface: simulates,
// reconstructs and measures scenes of one preset in one command.
#pragma once

#include <string>
#include <vector>

#include "experiments/chain.h"
#include "experiments/experiment.h"

namespace axial::experiments {

struct CompletenessOptions {
  std::string preset = "closeup";      // a preset of SimulateUnderwater
  std::string medium = "water";        // of the photographs for the cloud: "air" or "water"
  std::string poses = "true";          // "true", or "colmap": by COLMAP from photographs in air
  std::vector<int> seeds{11, 12, 13};  // seeds of the scenes: at least one, each only once
  // The tolerance of the evaluation [m]. 0: 2 mm for presets whose name starts with "closeup" or
  // "thicket", otherwise 5 mm.
  double tolerance = 0;
  // `scene`: more options of SimulateUnderwater. `dense`: more options of DensifyPointCloud.
  Words scene, dense;
};

// Returns the name of the experiment from preset, medium and poses:
// "completeness_closeup_water_true".
std::string completeness_name(const CompletenessOptions& options);

// Returns the tolerance of the evaluation [m]: `options.tolerance`, or that of the preset.
double tolerance_of(const CompletenessOptions& options);

// Returns the experiment. It has one part for each seed. The result of a part is the report of
// EvaluateReconstruction without histograms, and "cpu_seconds", the CPU time of DensifyPointCloud
// [s]. The scenes and clouds stay in `chain.work`. Error if a program of the chain cannot be read.
// Part::compute runs the programs, and throws an Error if a program fails. Precondition: every
// field of `options` has a value that its comment allows.
Experiment completeness(const Chain& chain, const CompletenessOptions& options);

}  // namespace axial::experiments
