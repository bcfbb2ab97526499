// SPDX-License-Identifier: GPL-3.0-or-later
// Fuses depth maps to one point cloud.
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
  std::uint32_t image = 0;  // index into Scene::images
  // Images whose pixels may support this view's points, best first (filter_neighbours). Images
  // without a FusionView of their own are ignored.
  std::vector<std::uint32_t> neighbours;
  // Views are fused in decreasing rank, views of equal rank in the order of `image`. The rank is
  // the number of unfiltered neighbours.
  std::size_t rank = 0;
};

// Functions that load the inputs. Both are called with an index into Scene::images, as late as
// possible, from at most FuseOptions::max_loads threads. A view is loaded once, unless max_maps is
// so small that its map has to be evicted and loaded again.
struct FusionProviders {
  std::function<DepthMap(std::size_t image)> load_map;
  // The image in B G R at the depth map's size. Empty function: the cloud has no colours.
  std::function<cv::Mat3b(std::size_t image)> load_color;
};

struct FuseOptions {
  // The number of images that must agree on a point, including the image of the point's first
  // pixel; at most the number of views. Below 2 the maps are merged without tests: every valid
  // pixel becomes a point with one view.
  std::size_t min_views = 3;
  // With min_views above 2: two images are enough if no other image disagrees and both maps pass
  // the test for surfaces (see fuse).
  bool two_if_undisputed = true;
  double depth_threshold = 0.005;                             // relative, along the neighbour's ray
  double normal_threshold = 40.0 * std::numbers::pi / 180.0;  // [rad]
  bool normals = true;                                        // fill PointCloud::normals
  bool errors = false;  // fill PointCloud::errors and confidences (point_error.h)

  // Limits of memory (see bytes_needed); the cloud does not depend on them. max_maps: maps in
  // memory at the same time, but never fewer than a view and its neighbours. max_loads: calls of
  // the providers at the same time.
  std::size_t max_maps = std::numeric_limits<std::size_t>::max();
  std::size_t max_loads = 1;
};

// Adds the points of `portion` to `cloud`. Preconditions: both have the same attributes, and
// view_begin of an empty `cloud` is {0}.
void append(PointCloud& cloud, const PointCloud& portion);

// Receives the next points of a cloud.
using CloudSink = std::function<void(PointCloud portion)>;

// Fuses the depth maps of `views` and passes the cloud to `sink` in portions. The views are
// processed one after the other. For every pixel with a depth that is not used yet:
//
// * The pixel's point is projected into each neighbour of the view and compared with the depth of
//   the nearest pixel there. The neighbour agrees if depth and normal agree within the thresholds.
//   It disagrees if its depth is larger (it sees through the point) or its normal differs. It is
//   neutral if the point is outside its image or hidden behind its surface, or if its map has no
//   depth there.
// * The point is accepted if min_views images agree, counting neighbours only whose pixel is not
//   used yet. With `two_if_undisputed` one such neighbour is enough if no neighbour disagrees, and
//   if the pixel lies in a piece of surface in its own map and in the map of the first neighbour
//   that agrees: of the eight pixels at a distance of two, at least four are nearer to the pixel's
//   tangent plane than half of depth_threshold times the depth, and at most three are not.
// * The point is the mean of the back-projected pixels that agree (eq. 4), with the weights
//   1 / (max(1 - confidence, 0.03) depth^2). Colour and normal are means with the same weights. The
//   pixels are then used. Pixels of neighbours that see through an accepted point are discarded.
//
// So each pixel of a depth map supports at most one point. Positions, weights and views (sorted by
// image) are always filled. Maps without normals get normals from their depths
// (estimate_map_normals); a pixel without a normal passes every normal test. The cloud is identical
// for any number of threads. Besides the maps, only one bit per pixel is kept for each view that is
// still needed. Throws an Error for a view that does not exist or is given twice, and for a map
// whose camera, normals, confidences or image do not have the size of its depths.
void fuse(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
          const FuseOptions& options, const CloudSink& sink, const ProgressSink& progress = {});

// The same, but returns the whole cloud.
PointCloud fuse(const Scene& scene, std::span<const FusionView> views,
                const FusionProviders& providers, const FuseOptions& options = {},
                const ProgressSink& progress = {});

// The sizes on which the memory of fusion depends.
struct FusionSize {
  std::uint64_t pixels = 0;  // of the largest map
  std::uint64_t views = 0;
  std::uint64_t maps = 0;  // in memory at the same time (FuseOptions::max_maps)
  bool colors = false;
};

// An upper bound of the memory [bytes] that fuse() holds, without the portions of the cloud and
// what the providers need while they load.
std::uint64_t bytes_needed(const FusionSize& size);

// Estimates a map's normals from the back-projected points in the 3x3 neighbourhood of each pixel.
// Only neighbours count whose depth differs by less than 3 % from the pixel's; at least 3 are
// needed. The normals have unit length, are in the camera frame and face the camera. 0 where there
// is no depth or where the estimation fails.
cv::Mat3f estimate_map_normals(const DepthMap& map);

}  // namespace axial::cloud
