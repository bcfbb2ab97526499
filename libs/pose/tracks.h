// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks of a bundle: triangulation through ports, and rejection of outliers.
#pragma once

#include <optional>
#include <span>

#include "pose/bundle.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

// The point with the least sum of squared distances to the rays (metres, any common frame). Empty
// for fewer than two rays, for parallel rays, and for rays that meet behind their origins.
std::optional<Eigen::Vector3d> triangulate(std::span<const refractive::AxialRay<double>> rays);

// Triangulates all points from the rays of their observations. Points without a solution keep their
// position.
void triangulate(Bundle& bundle);

// If a point has several observations in one image, as tracks of some engines have, keeps the
// observation with the least error, the first of equal ones. Returns the number dropped.
std::size_t drop_repeated(Bundle& bundle);

struct TrackLimits {
  double max_error = 4;               // [px]
  double min_angle = 1.5;             // [degrees] between some two rays of a point
  std::size_t min_observations = 30;  // of an image: fewer may fit a wrong pose
};

// Why observations were dropped.
struct DropCounts {
  std::size_t errors = 0;       // error too large
  std::size_t weak_images = 0;  // image with too few observations left
  std::size_t weak_points = 0;  // point seen by one image, or under too narrow an angle
};

// Drops observations with errors above the limit. Then drops all observations of images that have
// too few, and of points that fewer than two images see or that are seen under too narrow an angle,
// and repeats this until nothing changes. Points without observations are removed. Returns the
// number of dropped observations, and adds the numbers by reason to `counts`.
std::size_t filter(Bundle& bundle, const TrackLimits& limits, DropCounts* counts = nullptr);

}  // namespace axial::pose
