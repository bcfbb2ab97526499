// SPDX-License-Identifier: GPL-3.0-or-later
// Merges neighbouring points of a cloud.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/mesh.h"
#include "mesh/view_rays.h"

namespace axial::mesh {

// The result of merge_points(). Each point stands for one or several points of a cloud. The views
// of point i have the indices [view_begin[i], view_begin[i + 1]).
struct MergedPoints {
  std::vector<Eigen::Vector3f> positions;  // weighted means [m], in the frame of the cloud
  std::vector<float> pixel_widths;  // width [m] of a pixel at the point, in its sharpest view
  std::vector<std::size_t> view_begin{0};
  std::vector<std::uint32_t> view_images;  // indices into Scene::images, ascending for each point
  std::vector<float> view_weights;         // per view: number of absorbed points that it sees

  std::size_t count = 0;  // of merged points; more than size() if there were too many to keep

  std::size_t size() const { return positions.size(); }
};

// Merges the points of `cloud`. The points with the most views are taken first, and of points with
// equally many views the first in the cloud. A point p that is taken and not absorbed yet absorbs
// itself, and each other point q that is not absorbed yet and satisfies three conditions:
//
// - In each view of p in which the projection of p is visible, the images of p and q are at most
//   `min_distance` [px] apart, to first order: the derivative of the image position at p is used.
// - The distance from p to q in space is at most twice `min_distance` times the width [m/px] of a
//   pixel at p in its sharpest view.
// - If the cloud has normals, the normals of p and q differ by at most 60 degrees.
//
// The position of the result is the weighted mean of the absorbed points. The weight of a point is
// the sum of its PointCloud::view_weights, or its number of views if the cloud has no weights.
// Points whose projection is visible in none of their views are dropped, unless another point
// absorbs them. The result is in the order of a space-filling curve, which depends only on the
// positions. With more than MergeOptions::most_points merged points, the result has no points but
// their number (MergedPoints::count). Preconditions: the cloud has views (view_begin is not empty),
// and the views are calibrated images of the scene of `rays`.
MergedPoints merge_points(const PointCloud& cloud, const ViewRays& rays,
                          const MergeOptions& options = {});

// Brings points into the order of merge_points().
void sort_in_space(MergedPoints& points);

// Returns the indices of `points` in the order of a Morton curve through the bounding cube of the
// points. So most points that are near in space are near in the order. The cube is divided into
// 2^63 cells. Points in the same cell keep their order in `points`. Precondition: the positions are
// finite.
std::vector<std::uint32_t> spatial_order(std::span<const Eigen::Vector3f> points);

}  // namespace axial::mesh
