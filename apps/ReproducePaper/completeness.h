// SPDX-License-Identifier: GPL-3.0-or-later
// How complete clouds are by the number of cameras that see a place: scenes of one preset
// simulated, reconstructed and measured in one command.
#pragma once

#include <vector>

#include "chain.h"
#include "experiments/experiment.h"

namespace axial {

struct CompletenessOptions {
  std::string preset = "closeup", medium = "water", poses = "true";  // "colmap": of photos in air
  std::vector<int> seeds{11, 12, 13};
  double tolerance = 0;  // [m]; 0: 5 mm, and 2 mm for what is seen from less than a metre
  Words scene, dense;    // more options of SimulateUnderwater and of DensifyPointCloud
};

// Error that names the option: a medium, poses or a tolerance that there are not, no seed, or one
// seed twice.
void check(const CompletenessOptions& options);

// "completeness_closeup_water_true".
std::string completeness_name(const CompletenessOptions& options);

// One part a seed. Documents: one, completeness_....md, of a row a seed and one of their medians.
experiments::Experiment completeness(const Chain& chain, const CompletenessOptions& options);

}  // namespace axial
