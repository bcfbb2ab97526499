// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): the next pixels of one view, and the points that come of them.
#pragma once

#include <span>
#include <vector>

#include "cloud/fusion_map.h"
#include "cloud/point_error.h"
#include "cloud/two_views.h"

namespace axial::cloud {

// A view at work: its map, and which of its pixels support a point already or were proved wrong.
struct WorkingView {
  std::uint32_t image;
  const FusionMap* map;
  std::vector<bool>* taken;
  double reduction = 1;  // width of the photograph / of the map
};

// Call collect, ask, accept and points in this order, again and again.
class Portion {
 public:
  // The reference view first, then its neighbours, best first.
  explicit Portion(std::span<const WorkingView> views);

  // Takes the reference's next pixels that are free and have a depth, from `pixel` on. Returns
  // where to go on.
  std::size_t collect(std::size_t pixel);

  // Asks the neighbours what they say to these pixels, and finds those that two views prove.
  void ask(const FuseOptions& options);

  // Decides which pixels become points and takes their supports: with `min_views`, or with two or
  // more where two prove it.
  void accept(std::size_t min_views);

  std::size_t size() const { return begin_.size() - 1; }  // accepted points

  // The accepted points, averaged; colours if the maps have them.
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
  std::vector<PixelPoints> where_;  // the reference's pixels that ask; the others' supports
  std::vector<std::vector<Answer>> answers_;  // of each neighbour to each asking pixel
  std::vector<std::uint8_t> proved_by_two_;   // of each asking pixel, or empty
  std::vector<Support> supports_;             // of point i: [begin_[i], begin_[i + 1])
  std::vector<std::size_t> begin_;
  std::vector<SupportCamera> cameras_;  // of the views, or empty while nobody wants errors
};

}  // namespace axial::cloud
