// SPDX-License-Identifier: GPL-3.0-or-later
// Completeness of clouds by the number of cameras that see a place: simulates, reconstructs and
// measures scenes of one preset in one command.
#pragma once

#include <vector>

#include "chain.h"
#include "experiments/experiment.h"

namespace axial {

struct CompletenessOptions {
  // Poses "colmap": computed from photographs in air.
  std::string preset = "closeup", medium = "water", poses = "true";
  std::vector<int> seeds{11, 12, 13};
  double tolerance = 0;  // [m]; 0: 2 mm for the presets closeup and thicket, else 5 mm
  Words scene, dense;    // more options of SimulateUnderwater and of DensifyPointCloud
};

// Error that names the option for an unknown medium, unknown poses, an invalid tolerance, and for
// seeds that are missing or occur twice.
void check(const CompletenessOptions& options);

// "completeness_closeup_water_true".
std::string completeness_name(const CompletenessOptions& options);

// One part for each seed. One document, completeness_....md: one row for each seed, and a row of
// medians.
experiments::Experiment completeness(const Chain& chain, const CompletenessOptions& options);

}  // namespace axial
