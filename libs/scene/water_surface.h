// SPDX-License-Identifier: GPL-3.0-or-later
// The calm surface of the water, seen from the air: a flat port that stays where it is in the
// world, and so another one for every camera.
#pragma once

#include <string>

#include "refractive/flat_port.h"
#include "scene/pose.h"

namespace axial {

// A plane without glass [world]. Nothing here needs metres: only the unit of the poses.
struct WaterSurface {
  Eigen::Vector3d normal{0, 0, -1};  // unit, from the air into the water
  Eigen::Vector3d point{0, 0, 0};    // any point of the plane
  double n_air = 1;
  double n_water = 1.333;

  // Of a point over the plane; negative in the water.
  double height_of(const Eigen::Vector3d& x) const { return normal.dot(point - x); }
};

// The surface as the camera at `pose` has it: the normal R n, the camera's height for a distance, a
// thickness of 0. Error that starts with `where` unless the camera is above the surface and its
// optical axis meets it; rays that look into the water then never run backwards (z > 0).
refractive::FlatPort<double> port_seen_from(const Pose& pose, const WaterSurface& surface,
                                            const std::string& where);

}  // namespace axial
