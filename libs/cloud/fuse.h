// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps to one point cloud (OPENMVS_FACTS 6.7).
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "base/progress.h"
#include "scene/depth_map.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// One image that has a depth map.
struct FusionView {
  std::uint32_t image = 0;                // index into Scene::images
  std::vector<std::uint32_t> neighbours;  // images to join, best first (filter_neighbours); those
                                          // without a FusionView of their own are ignored
  std::size_t rank =
      0;  // views are fused in decreasing rank (unfiltered neighbours), ties by image
};

// Both are called with an index into Scene::images, as late as possible, from up to
// FuseOptions::max_loads threads; once a view unless max_maps makes it necessary to load one again.
struct FusionProviders {
  std::function<DepthMap(std::size_t image)> load_map;
  // B G R at the depth map's size. Empty function: no colours.
  std::function<cv::Mat3b(std::size_t image)> load_color;
};

struct FuseOptions {
  // Images that must agree on a point (their own included; capped by the number of views). Below 2:
  // plain merge, every valid pixel is a point with one view.
  std::size_t min_views = 3;
  // With min_views above 2: two images that agree on a point are enough where no other image
  // disagrees, on stricter evidence (fuse).
  bool two_if_undisputed = true;
  double depth_threshold = 0.005;                             // relative, along the neighbour's ray
  double normal_threshold = 40.0 * std::numbers::pi / 180.0;  // [rad]
  bool normals = true;                                        // fill PointCloud::normals
  bool errors = false;  // fill PointCloud::errors and confidences (point_error.h)

  // What memory allows; the cloud does not depend on it. Maps in memory at a time (20 bytes a
  // pixel, 3 more with colours), but never fewer than a view and its neighbours; calls of the
  // providers at the same time.
  std::size_t max_maps = std::numeric_limits<std::size_t>::max();
  std::size_t max_loads = 1;
};

// Adds the points of `portion`, which has the same attributes, to `cloud`, whose view_begin starts
// as {0}.
void append(PointCloud& cloud, const PointCloud& portion);

// Takes the next points of a cloud.
using CloudSink = std::function<void(PointCloud portion)>;

// Every pixel that belongs to no point yet asks its view's neighbours: those whose depth at the
// projection agrees in depth and normal join, and their pixels are used up. With
// `two_if_undisputed`, one neighbour that joins is enough where no other disagrees. A neighbour
// disagrees that sees through the point or shows another normal there. It says nothing if the point
// is outside its image or hidden behind the surface of its map, or if its map has no depth there;
// and one that agrees, but whose pixel belongs to a point already, does not forbid the point. In
// the pixel's map and in that of the first neighbour that agrees, the pixel must lie in a piece of
// surface: of the eight pixels two away, four or more are less than half depth_threshold times the
// depth away from the pixel's tangent plane, and at most three farther. A point with enough views
// is the mean of the back-projected pixels (eq. 4), weighted with 1 / (max(1 - confidence, 0.03)
// depth^2), as are its colour and normal; depths that it proves wrong (a neighbour sees behind it)
// are deleted. Each pixel of a depth map supports at most one point. Positions, weights and views
// (sorted by image) are always filled. Maps without normals get them from depth
// (estimate_map_normals); pixels without a normal skip the normal test. The same bytes for any
// number of threads. The cloud is handed on in portions: besides the maps only one bit a pixel is
// kept of the views that are not done yet. Error for a map whose size, image and normals disagree.
void fuse(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
          const FuseOptions& options, const CloudSink& sink, const ProgressSink& progress = {});

// The same, all portions in one.
PointCloud fuse(const Scene& scene, std::span<const FusionView> views,
                const FusionProviders& providers, const FuseOptions& options = {},
                const ProgressSink& progress = {});

// Normals from 3x3 neighbourhoods of back-projected points with depths within 3 % of the pixel's
// (at least 3 of them), camera frame, facing the camera; 0 where that fails or depth is 0.
cv::Mat3f estimate_map_normals(const DepthMap& map);

}  // namespace axial::cloud
