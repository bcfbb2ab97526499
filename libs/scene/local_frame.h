// SPDX-License-Identifier: GPL-3.0-or-later
// A frame with its origin near the scene, for scenes far from the origin of their world, as in UTM
// coordinates. So far from the origin, float coordinates are too coarse for the scene's details.
#pragma once

#include <Eigen/Core>
#include <span>

#include "scene/scene.h"

namespace axial {

// A frame whose axes are parallel to those of the world: world = local + origin. With a zero origin
// the frame is the world.
struct LocalFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // [world]

  bool is_world() const { return origin.isZero(0); }
  Eigen::Vector3d to_local(const Eigen::Vector3d& world) const { return world - origin; }
  Eigen::Vector3d to_world(const Eigen::Vector3d& local) const { return local + origin; }
};

// Returns the world if `place` lies within 1,000 units of its origin. Otherwise the origin of the
// result is `place`, rounded to 10 units. Because of this rounding, conversion to the local frame
// and back changes a coordinate by no more than the rounding of a double of the local coordinate's
// size.
LocalFrame frame_near(const Eigen::Vector3d& place);

// Returns the world if there are no `centres`, or if all camera centres and the median of `points`
// lie within 1,000 units of the world's origin. `points` may be empty. Otherwise the origin of the
// result is the median of the centres, coordinate by coordinate, rounded to 10 units. The order of
// centres and points does not matter.
LocalFrame frame_of(std::span<const Eigen::Vector3d> centres,
                    std::span<const Eigen::Vector3d> points);

// The same with the centres of the calibrated cameras and the sparse points of `scene`.
LocalFrame frame_of(const Scene& scene);

// Transforms `scene` from world coordinates to `frame`: poses, sparse points and region. Sparse
// points are float, and do not become more precise in the local frame.
void enter(const LocalFrame& frame, Scene& scene);

}  // namespace axial
