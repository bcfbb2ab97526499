// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks of a bundle: triangulation through ports, and rejection of outliers.
#pragma once

#include <optional>
#include <span>

#include "pose/bundle/bundle.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

// The point [m, frame of the rays] with the smallest sum of squared distances to the lines of the
// rays. Empty for fewer than two rays, for parallel rays, or if the point lies behind the origin of
// a ray. Precondition: all rays are in one frame.
std::optional<Eigen::Vector3d> triangulate(std::span<const refractive::AxialRay<double>> rays);

// The ray of `pixel` in an image at `pose`, in the frame of the poses. NaN if the pixel is the
// image of no direction.
refractive::AxialRay<double> world_ray(const PhotographCamera& camera, const Pose& pose,
                                       const Eigen::Vector2d& pixel);

// The largest angle [rad] between any two of the rays. 0 for fewer than two rays.
double widest_angle(std::span<const refractive::AxialRay<double>> rays);

// Triangulates all points from the rays of their observations. Observations whose pixel is the
// image of no direction are not used. A point for which triangulate(rays) returns nothing keeps its
// position.
void triangulate(Bundle& bundle);

// For each point with several observations in one image, as in the tracks of some engines, keeps
// only the observation with the smallest reprojection error (the first of equal errors). Returns
// the number of dropped observations.
std::size_t drop_repeated(Bundle& bundle);

struct TrackLimits {
  double max_error = 4;  // largest reprojection error of an observation [px]
  // The widest angle between two rays of a point must be at least this large [degrees].
  double min_angle = 1.5;
  // Least number of observations of an image. Fewer observations may fit a wrong pose.
  std::size_t min_observations = 30;
};

// The numbers of observations that were dropped, by reason.
struct DropCounts {
  std::size_t errors = 0;       // error too large
  std::size_t weak_images = 0;  // image with too few observations left
  std::size_t weak_points = 0;  // point seen by one image, or under too narrow an angle
};

// Drops observations that do not fit. First drops all observations with reprojection errors above
// `max_error`. Then repeats two steps until nothing changes:
// - Drops all observations of images with fewer than `min_observations`. The images stay in the
//   bundle.
// - Removes points that fewer than two images observe or whose widest angle is below `min_angle`,
//   with their observations. The other points and observations keep their order, but indices
//   change.
//
// Returns the number of dropped observations. Adds the numbers by reason to `counts` if it is not
// null.
std::size_t filter(Bundle& bundle, const TrackLimits& limits, DropCounts* counts = nullptr);

}  // namespace axial::pose
