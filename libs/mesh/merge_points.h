// SPDX-License-Identifier: GPL-3.0-or-later
// Merges neighbouring points of a cloud.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/view_rays.h"
#include "scene/point_cloud.h"

namespace axial::mesh {

struct MergeOptions {
  // Points that are closer than this in all images that see the point [px] are merged. 0: none.
  double min_distance = 2.5;
};

// Points that each stand for one or several points of a cloud. The views of point i are at
// [view_begin[i], view_begin[i + 1]).
struct MergedPoints {
  std::vector<Eigen::Vector3f> positions;  // weighted means [m], in the frame of the cloud
  std::vector<float> pixel_widths;         // a pixel of the sharpest view, seen at the point [m]
  std::vector<std::size_t> view_begin{0};
  std::vector<std::uint32_t> view_images;  // indices into Scene::images, ascending for each point
  std::vector<float> view_weights;         // number of points of the cloud that the view sees

  std::size_t size() const { return positions.size(); }
};

// Merges the points of `cloud`. The points with the most views are taken first. Each point that is
// not merged yet absorbs its neighbours: the points that lie within min_distance in each of its
// views and within two such distances in space, and whose normals differ by less than 60 degrees.
// The position of the result is the mean of the absorbed points, weighted by their view_weights.
// Points that no view sees are dropped. The result is in the order of a space-filling curve, which
// depends only on the positions. Precondition: the cloud has views, and they are calibrated images
// of the scene of `rays`.
MergedPoints merge_points(const PointCloud& cloud, const ViewRays& rays,
                          const MergeOptions& options = {});

}  // namespace axial::mesh
