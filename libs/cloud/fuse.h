// SPDX-License-Identifier: GPL-3.0-or-later
// Fuses depth maps to one point cloud.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/cloud.h"
#include "base/progress.h"
#include "cloud/tiles.h"
#include "scene/depth_map.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// One image that has a depth map.
struct FusionView {
  std::uint32_t image = 0;  // index into Scene::images
  // Indices into Scene::images of the images whose pixels may support the points of this view, best
  // first: the result of filter_neighbours() (scene/view_selection.h). Images that have no
  // FusionView of their own, `image` itself and repetitions are ignored.
  std::vector<std::uint32_t> neighbours;
  // Views are fused in decreasing order of rank. Views of equal rank are fused in the order of
  // `image`. The caller sets the rank to the number of neighbours of the image before
  // filter_neighbours().
  std::size_t rank = 0;
};

// Functions that load the inputs. `image` is an index into Scene::images. Up to
// FuseOptions::max_loads threads call the functions at the same time. A view is loaded when fusion
// first needs it. It is loaded again only if FuseOptions::max_maps is so small that its map had to
// be freed.
struct FusionProviders {
  // Returns the depth map of the image. Must not be empty.
  std::function<DepthMap(std::size_t image)> load_map;
  // Returns the image in B G R at the depth map's size. If the function itself is empty, the cloud
  // has no colours.
  std::function<cv::Mat3b(std::size_t image)> load_color;
};

// Appends the points of `portion` to `cloud`. Preconditions: both have the same attributes, and the
// view_begin of an empty `cloud` is {0}.
void append(PointCloud& cloud, const PointCloud& portion);

// Receives the next points of a cloud, at least one. PointCloud::view_begin of each portion starts
// at 0. Called in the thread that called fuse().
using CloudSink = std::function<void(PointCloud portion)>;

// Fuses the depth maps of `views` and passes the cloud to `sink` in portions. The views are
// processed one after the other. Each pixel that has a depth and is not used yet is processed as
// follows:
//
// * The point of the pixel is projected into each neighbour of the view and compared with the
//   nearest pixel there. The depth agrees if it differs by less than depth_threshold times the
//   depth of the point, and the normal agrees within normal_threshold. The neighbour agrees if both
//   agree. The neighbour disagrees in two cases: its depth does not agree and is larger, so that it
//   sees through the point, or its depth agrees and its normal does not. The neighbour is neutral
//   in all other cases: the point is outside the neighbour's image, the neighbour's map has no
//   depth there, or its depth does not agree and is smaller, so that a nearer surface hides the
//   point.
// * The point is accepted if min_views images agree. The view itself counts as one image. A
//   neighbour counts if it agrees and its pixel is not used yet. With `two_if_undisputed` one
//   neighbour that counts is enough under three conditions: no neighbour disagrees, the pixel lies
//   in a piece of surface of its map, and the nearest pixel in the first neighbour that agrees lies
//   in a piece of surface of the neighbour's map.
// * A pixel lies in a piece of surface if, of the eight pixels that are 2 px away in x, in y or in
//   both, at least four lie on the tangent plane of the pixel and at most three do not. Pixels
//   without a depth do not count. A pixel lies on the tangent plane if its point is nearer to the
//   plane than half of depth_threshold times the depth of the pixel in the middle.
// * The supports of an accepted point are the pixel itself and the pixels of the neighbours that
//   count. The position of the point is the weighted mean of the back-projected supports. The
//   weights are 1 / (max(1 - confidence, 0.03) depth^2). Colour and normal are means with the same
//   weights. After this, the supports count as used. The pixels of neighbours that see through the
//   point are discarded, which means that they count as used.
//
// With FuseOptions::part, pixels whose points lie outside `reach` are not processed, but they can
// still support the points of other pixels. Of the points, those in `tile` are passed to `sink`.
// Whether a pixel is still unused depends on the points before it, which are near. So the points in
// a tile are those of the whole cloud, except for few differences near its borders. They become
// fewer the farther `reach` extends beyond `tile`.
//
// So each pixel of a depth map supports at most one point. Positions, weights and views (sorted by
// image) are always filled. A map without normals gets normals from its depths
// (estimate_map_normals). A pixel without a normal passes every normal test. The cloud is identical
// for any number of threads. `progress` counts the views that have enough neighbours for a point.
// The memory is that of the maps, and one bit per pixel for each view that is still needed. Throws
// an Error in these cases: a view's image is not in the scene or is given twice, a depth map or a
// loaded image is empty, or the camera, the normals, the confidences or the image of a map do not
// have the size of its depths.
void fuse(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
          const FuseOptions& options, const CloudSink& sink, const ProgressSink& progress = {});

// Fuses the depth maps as above, but returns the whole cloud.
PointCloud fuse(const Scene& scene, std::span<const FusionView> views,
                const FusionProviders& providers, const FuseOptions& options = {},
                const ProgressSink& progress = {});

// The number of views whose pixels fuse() marks as used when it fuses the part: the processed views
// and their neighbours. FusionSize::views of the part. Precondition: the images of `views` differ.
std::size_t views_needed(std::span<const FusionView> views, const FusionPart& part);

// The sizes on which the memory of fuse() depends.
struct FusionSize {
  std::uint64_t pixels = 0;  // number of pixels of the largest map
  std::uint64_t views = 0;   // number of FusionViews; of a part: views_needed()
  std::uint64_t maps = 0;    // number of maps in memory at the same time (FuseOptions::max_maps)
  bool colors = false;       // whether FusionProviders::load_color is given
};

// An upper bound of the memory [bytes] that fuse() holds. Precondition: size.maps is at least 1
// plus the largest number of neighbours of any view, and at most size.views. The portions of the
// cloud and the memory that the providers need while they load are not included.
std::uint64_t bytes_needed(const FusionSize& size);

}  // namespace axial::cloud
