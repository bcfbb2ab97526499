// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): the next pixels of one view, and the points made from them.
#pragma once

#include <span>
#include <vector>

#include "cloud/fusion_map.h"
#include "cloud/point_error.h"
#include "cloud/tiles.h"
#include "cloud/two_views.h"

namespace axial::cloud {

// A view that is being fused.
struct WorkingView {
  std::uint32_t image;       // index into Scene::images
  const FusionMap* map;      // must outlive ViewFusion
  std::vector<bool>* taken;  // per pixel of the map: it supports a point already, or was discarded
  double reduction = 1;      // width of the photograph divided by the width of the map
};

// Makes the points of a view in steps. A step processes some pixels: call collect(), compare(),
// accept() and points() in this order. Repeat until all pixels are processed.
class ViewFusion {
 public:
  // `views`: first the reference view, whose pixels become points, then its neighbours, best first.
  explicit ViewFusion(std::span<const WorkingView> views);

  // Begins a step. Collects some pixels of the reference view that have a depth and are not taken,
  // from the pixel with the number `pixel` (y * width + x) on. Returns the number of the pixel at
  // which the next step begins. If no pixel is left, this is the number of pixels of the view.
  std::size_t collect(std::size_t pixel);

  // Drops the collected pixels whose points lie outside `box`. To be called after collect().
  void keep_collected_in(const Tile& box);

  // Compares the collected pixels with the maps of all neighbours. Finds the collected pixels for
  // which two views are enough (two_views.h).
  void compare(const FuseOptions& options);

  // Decides which collected pixels become points, and marks the pixels that support these points as
  // taken. A point needs `min_views` supports (one is the collected pixel itself), or two supports
  // if two views are enough. Also marks the pixels of neighbours that see through an accepted point
  // as taken.
  void accept(std::size_t min_views);

  std::size_t size() const { return begin_.size() - 1; }  // number of accepted points of this step

  // The accepted points of this step as means of their supports, with colours if the maps have
  // colours. `options`: whether the cloud has normals, errors and confidences.
  PointCloud points(const FuseOptions& options) const;

 private:
  // One pixel that supports a point: entry `index` of where_[view].
  struct Support {
    std::uint32_t view;
    std::uint32_t index;
  };

  void find_proved_by_two(const FuseOptions& options);
  void average(std::size_t point, PointCloud& cloud) const;
  void estimate_errors(PointCloud& cloud) const;

  std::vector<WorkingView> views_;
  std::vector<PixelPoints> where_;  // [0]: the collected pixels; [v]: supports in views_[v]
  std::vector<std::vector<Answer>> answers_;  // of each neighbour to each collected pixel
  std::vector<std::uint8_t> proved_by_two_;   // per collected pixel: two views are enough; or empty
  std::vector<Support> supports_;             // of point i: [begin_[i], begin_[i + 1])
  std::vector<std::size_t> begin_;
  std::vector<SupportCamera> cameras_;  // one per view, or empty without FuseOptions::errors
};

}  // namespace axial::cloud
