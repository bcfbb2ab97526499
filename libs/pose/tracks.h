// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks of a bundle: triangulation through ports, and rejection of outliers.
#pragma once

#include <optional>
#include <span>

#include "pose/bundle.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

// The point with the smallest sum of squared distances to the rays [m, any common frame]. Nothing
// for fewer than two rays, for parallel rays, or if the point lies behind the origin of a ray.
std::optional<Eigen::Vector3d> triangulate(std::span<const refractive::AxialRay<double>> rays);

// Triangulates all points from the rays of their observations. A point for which triangulate(rays)
// returns nothing keeps its position.
void triangulate(Bundle& bundle);

// For each point with several observations in one image, as in the tracks of some engines, keeps
// only the observation with the smallest error (the first of equal errors). Returns the number of
// dropped observations.
std::size_t drop_repeated(Bundle& bundle);

struct TrackLimits {
  double max_error = 4;               // of an observation [px]
  double min_angle = 1.5;             // least widest angle between two rays of a point [degrees]
  std::size_t min_observations = 30;  // of an image; fewer observations may fit a wrong pose
};

// Why observations were dropped.
struct DropCounts {
  std::size_t errors = 0;       // error too large
  std::size_t weak_images = 0;  // image with too few observations left
  std::size_t weak_points = 0;  // point seen by one image, or under too narrow an angle
};

// Drops observations that do not fit. First drops all observations with errors above the limit.
// Then repeats two steps until nothing changes:
// - Drops all observations of images with fewer than `min_observations`.
// - Removes points that fewer than two images observe or whose widest angle is below `min_angle`,
//   with their observations.
//
// Returns the number of dropped observations. Adds the numbers by reason to `counts` if it is not
// null.
std::size_t filter(Bundle& bundle, const TrackLimits& limits, DropCounts* counts = nullptr);

}  // namespace axial::pose
