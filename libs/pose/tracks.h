// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks of a bundle: triangulation through ports, and which observations to believe.
#pragma once

#include <optional>
#include <span>

#include "pose/bundle.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

// The point with the least sum of squared distances to the rays (metres, any common frame). Nothing
// for fewer than two rays, or where they are parallel or meet behind their origins.
std::optional<Eigen::Vector3d> triangulate(std::span<const refractive::AxialRay<double>> rays);

// All points anew from their observations' rays. Those that have none keep their place.
void triangulate(Bundle& bundle);

// Where a point has several observations in one image, as tracks of an engine may have, the one
// with the least error stays, the first of equal ones; so each image counts once. The number
// dropped.
std::size_t drop_repeated(Bundle& bundle);

struct TrackLimits {
  double max_error = 4;               // [px]
  double min_angle = 1.5;             // [degrees] between some two rays of a point
  std::size_t min_observations = 30;  // of an image: fewer may fit a wrong pose
};

// Why observations were dropped.
struct DropCounts {
  std::size_t errors = 0;       // too large
  std::size_t weak_images = 0;  // of images with too few observations left
  std::size_t weak_points = 0;  // of points seen by one image, or under too narrow an angle
};

// Drops observations with larger errors, then all those of images with too few, and of points seen
// by fewer than two images or under too narrow an angle, until nothing is left to drop. The number
// dropped, and by reason in `counts`, to which it is added.
std::size_t filter(Bundle& bundle, const TrackLimits& limits, DropCounts* counts = nullptr);

}  // namespace axial::pose
