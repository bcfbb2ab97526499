// SPDX-License-Identifier: GPL-3.0-or-later
// A frame near a scene that lies far from its world's origin, as in UTM coordinates: there, float
// has no digits left for what the scene is about.
#pragma once

#include <Eigen/Core>
#include <span>

#include "scene/scene.h"

namespace axial {

// Axes as those of the world: world = local + origin. Without an origin the frame is the world.
struct LocalFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // [world]

  bool is_world() const { return origin.isZero(0); }
  Eigen::Vector3d to_local(const Eigen::Vector3d& world) const { return world - origin; }
  Eigen::Vector3d to_world(const Eigen::Vector3d& local) const { return local + origin; }
};

// The world if `place` lies within 1,000 units of its origin; else the frame at `place`, rounded to
// 10 units. Going to the local frame and back moves no coordinate by more than rounding a double of
// the local coordinate's size.
LocalFrame frame_near(const Eigen::Vector3d& place);

// The world if all camera `centres` and the median of `points` (which may be none) lie within 1,000
// units of its origin; else the frame at the median of the centres, coordinate by coordinate,
// rounded to 10 units. The same for any order of centres and points. The world for no centres.
LocalFrame frame_of(std::span<const Eigen::Vector3d> centres,
                    std::span<const Eigen::Vector3d> points);

// Of the calibrated cameras and the sparse points.
LocalFrame frame_of(const Scene& scene);

// Takes a scene in world coordinates into `frame`: poses, sparse points, region. Sparse points are
// float, and stay as coarse as they were.
void enter(const LocalFrame& frame, Scene& scene);

}  // namespace axial
