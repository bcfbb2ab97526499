// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of a photograph through a port, from points that are known and matches that may be
// wrong.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pose/bundle/bundle.h"

namespace axial::pose {

// A feature of a photograph and the point that it may show.
struct Sighting {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // [px] of the photograph
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // [m, world]
};

// A pose and the indices of the sightings that agree with it, in ascending order. Without a pose,
// no sighting agrees.
struct AbsolutePose {
  Pose pose;
  std::vector<std::size_t> inliers;
};

struct AbsolutePoseOptions {
  double max_error = 4;    // largest reprojection error of a sighting that agrees [px]
  double distance = 1;     // rough distance of the points [m]
  std::uint64_t seed = 0;  // of the random numbers: the same seed gives the same result
};

// Finds the pose with which most sightings agree: from random samples of three sightings
// (poses_of_three() in p3p.h), then by least squares with the exact projection (adjust()). A
// sighting agrees if the point is beyond the port and its reprojection error is small. Sightings at
// pixels without a ray never agree.
AbsolutePose absolute_pose(const BundleCamera& camera, std::span<const Sighting> sightings,
                           const AbsolutePoseOptions& options);

// How well a pose is determined.
struct PoseDoubt {
  double angle = 0;   // the largest standard deviation of the rotation about an axis [rad]
  double centre = 0;  // that of the centre along an axis, divided by the points' median distance
};

// The standard deviations of the pose from the sightings that agree with it. The standard deviation
// of a pixel comes from their errors, and is at least 0.5 px in x and in y. Both numbers are
// infinite if the sightings do not determine the pose.
PoseDoubt doubt_of(const BundleCamera& camera, std::span<const Sighting> sightings,
                   const AbsolutePose& found);

}  // namespace axial::pose
