// SPDX-License-Identifier: GPL-3.0-or-later
// Coded targets in a simulated survey, with true places.
#pragma once

#include <vector>

#include "pose/control/target_points.h"
#include "pose/survey.h"

namespace axial::pose::testing {

// A plate on the ground [m].
struct Plate {
  std::string label;
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;  // unit
  double size = 0.03;      // radius of the dot, or half the side of the square
  bool is_square = false;
};

struct SeenPlates {
  std::vector<Target> targets;  // as measured, with the standard deviation `noise`
  // The true images of the centres, in the order of the targets and of their images [px].
  std::vector<std::vector<Eigen::Vector2d>> centres;
};

// The plates in the images of `truth` that show the whole plate. `noise`: of each measured pixel
// [px]. The ellipse of a dot is that of the area of its image: its centre is the centroid.
SeenPlates seen_plates(const Bundle& truth, const std::vector<Plate>& plates, double noise,
                       unsigned seed);

// The target with this label.
const Target& target_named(const std::vector<Target>& targets, const std::string& label);

}  // namespace axial::pose::testing
