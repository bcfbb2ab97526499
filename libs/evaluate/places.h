// SPDX-License-Identifier: GPL-3.0-or-later
// Places of the truth that cameras see, and the share of them that a reconstruction contains: by
// the number of cameras, and by the thickness of the structure to which a place belongs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "evaluate/surface.h"
#include "evaluate/views.h"
#include "scene/mesh.h"

namespace axial::evaluate {

// Samples of the truth. All arrays have the length of `positions`, but `views` is empty if there
// are no cameras.
struct Places {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> faces;  // faces of the truth on which the samples lie
  std::vector<std::uint32_t> views;  // number of views that see each sample (count_views)
  std::size_t drawn = 0;             // samples of the truth before the selection

  std::size_t size() const { return positions.size(); }
};

struct PlaceDraw {
  std::size_t samples = 200000;
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;
};

// Draws samples of `truth`, uniform by area. Keeps those that at least `least_views` of `views`
// see, or all if there are no views. If few of `samples` samples are seen, up to 20 times as many
// are drawn, so that about `samples` remain. `surface` must be made from `truth`. Error if no
// sample is seen.
Places draw_places(const Mesh& truth, const Surface& surface, std::span<const View> views,
                   const PlaceDraw& draw);

// Recall of the places that `least` to `most` views see.
struct RecallOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: or more
  std::size_t places = 0;
  std::vector<double> recall;  // share of places within each tolerance; 0 without places
};

// Returns a class for exactly `least` views, for exactly one more, and so on, and a last class for
// 4 or more views (`least` or more, if `least` is above 4). `distances`: from each place to the
// reconstruction [m].
std::vector<RecallOfViews> recall_by_views(const Places& places, std::span<const float> distances,
                                           std::span<const double> tolerances, std::uint32_t least);

// Recall of the places on structures with a thickness in [least, most).
struct RecallOfThickness {
  double least = 0, most = 0;  // [px]; both 0: not thin; only most 0: `least` or more
  std::size_t places = 0;
  std::vector<double> recall;  // as RecallOfViews
};

// Returns classes by a factor of two around 1, 2, 4, 8 and 16 pixels, a class of thicker
// structures, and last the places that are not thin. `thickness`: of the structure at each vertex
// of the truth [m], 0 where it is not thin. It is converted to pixels with the mean pixel width of
// the views that see the place. Error unless there is one thickness for each vertex.
std::vector<RecallOfThickness> recall_by_thickness(const Places& places,
                                                   std::span<const float> distances,
                                                   std::span<const double> tolerances,
                                                   const Mesh& truth, const Surface& surface,
                                                   std::span<const float> thickness,
                                                   std::span<const View> views);

}  // namespace axial::evaluate
