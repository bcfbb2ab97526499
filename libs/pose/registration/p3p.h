// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of a camera from three points.
#pragma once

#include <array>
#include <vector>

#include "axial/scene.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

using ThreeVectors = std::array<Eigen::Vector3d, 3>;
using ThreeRays = std::array<refractive::AxialRay<double>, 3>;

// The poses, at most four, at which a central camera sees each of the `points` [world] in the
// direction of its bearing [camera frame, unit length]. The quartic of Grunert (R. Haralick et al.,
// "Review and analysis of solutions of the three point perspective pose estimation problem", 1994).
// Empty if the points lie on one line.
std::vector<Pose> p3p(const ThreeVectors& bearings, const ThreeVectors& points);

// The poses, at most four, at which each of the `points` [m, world] lies on its ray [m, camera
// frame], in front of its origin. The rays need not meet in one point. A central camera whose rays
// pass through the points of the rays at `distance` [m] gives the starts (p3p()), and Newton's
// method the poses. Precondition: `distance` is about the distance of the points, and the origins
// of the rays are much nearer to each other.
std::vector<Pose> poses_of_three(const ThreeRays& rays, const ThreeVectors& points,
                                 double distance);

}  // namespace axial::pose
