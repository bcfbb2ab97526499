// SPDX-License-Identifier: GPL-3.0-or-later
// Coded targets on the ground, and the truth about them.
#pragma once

#include <string>
#include <vector>

#include "arguments.h"
#include "simulate/plates.h"
#include "targets/codes/family.h"

namespace axial::apps {

struct PlatesOnGround {
  std::vector<simulate::Plate> plates;  // single ones first, then two for each bar
  std::vector<std::string> labels;      // of the plates
  std::vector<double> bars;             // lengths [m]
  targets::Family family;
};

// Lays the plates of --targets and --bars on `ground`, numbered from the family's first target on.
// Error if the family has too few targets or there is no room.
PlatesOnGround plates_on(const simulate::TriangleMesh& ground, const simulate::Preset& preset,
                         const Arguments& a);

// Writes <folder>/true_targets.json (docs/formats.md, "Targets"). `scene` contains the plates.
// `medium`: "air", "water" or "both".
void write_true_targets(const std::filesystem::path& folder, const PlatesOnGround& plates,
                        const simulate::RayScene& scene, const simulate::Preset& preset,
                        const std::string& medium);

}  // namespace axial::apps
