// SPDX-License-Identifier: GPL-3.0-or-later
// A frame with its origin near the scene, for scenes far from the origin of their world, for
// example in UTM coordinates. At such coordinates, float is too coarse for the details of the
// scene.
#pragma once

#include <Eigen/Core>
#include <span>

#include "axial/scene.h"

namespace axial {

// Returns the world (a zero origin) if `place` [world] lies within 1,000 units of the world's
// origin. Otherwise the origin of the result is `place`, with each coordinate rounded to a multiple
// of 10 units. The origin is rounded so that conversions lose little: if x is the local value of a
// coordinate, conversion to the local frame and back changes the coordinate by no more than the
// rounding error of a double of the size of x.
LocalFrame frame_near(const Eigen::Vector3d& place);

// Chooses a frame for a scene with the camera centres `centres` and the sparse points `points`
// [world]. `points` may be empty. The order of centres and of points does not matter. The first
// rule that applies is used:
// - Without `centres`, the result is the world.
// - If all camera centres and the median of `points` lie within 1,000 units of the world's
//   origin, the result is the world. Without points, only the centres decide.
// - Otherwise the origin of the result is the median of the centres, rounded to 10 units.
//
// Medians are taken coordinate by coordinate. Rounding is as in frame_near().
LocalFrame frame_of(std::span<const Eigen::Vector3d> centres,
                    std::span<const Eigen::Vector3d> points);

// Chooses the frame from the centres of the calibrated cameras and the sparse points of `scene`.
LocalFrame frame_of(const Scene& scene);

// Transforms the poses, sparse points and region of `scene` from world coordinates to `frame`, in
// place. Precondition: `scene` is in world coordinates. Sparse points are float, and do not become
// more precise in the local frame.
void enter(const LocalFrame& frame, Scene& scene);

}  // namespace axial
