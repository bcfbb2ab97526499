// SPDX-License-Identifier: GPL-3.0-or-later
// The calm surface of the water, seen from the air. It acts as a flat port that is fixed in the
// world, so that every camera has different port parameters.
#pragma once

#include <string>

#include "axial/scene.h"
#include "refractive/flat_port.h"

namespace axial {

// A plane without glass, in the world frame and in the unit of the poses, which need not be metres.
struct WaterSurface {
  Eigen::Vector3d normal{0, 0, -1};  // unit, from the air into the water
  Eigen::Vector3d point{0, 0, 0};    // any point of the plane
  double n_air = 1;                  // refractive index of the air
  double n_water = 1.333;            // refractive index of the water

  // The height of the point x [world] above the surface, in the unit of the poses; negative in the
  // water.
  double height_of(const Eigen::Vector3d& x) const { return normal.dot(point - x); }
};

// The surface as the flat port of the camera at `pose`. Let R be pose.rotation and n
// surface.normal. The normal of the port is R n, its distance is the height of the camera above the
// surface, and its thickness is 0. Throws an Error that starts with `where` unless the camera is
// above the surface and its optical axis points towards the surface. Under these conditions, the
// water rays of all pixels that show water have z > 0 in the camera frame.
refractive::FlatPort<double> port_seen_from(const Pose& pose, const WaterSurface& surface,
                                            const std::string& where);

}  // namespace axial
