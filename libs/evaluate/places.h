// SPDX-License-Identifier: GPL-3.0-or-later
// Places of the truth that cameras see, and how much of them a reconstruction has: by the number of
// cameras, and by the thickness of what they are part of.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "evaluate/surface.h"
#include "evaluate/views.h"
#include "scene/mesh.h"

namespace axial::evaluate {

// Samples of the truth. Every array is as long as `positions`; `views` is empty if there are no
// cameras.
struct Places {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> faces;  // of the truth, that they lie on
  std::vector<std::uint32_t> views;  // that see each of them, as count_views has it
  std::size_t drawn = 0;             // samples of the truth that they were chosen from

  std::size_t size() const { return positions.size(); }
};

struct PlaceDraw {
  std::size_t samples = 200000;
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;
};

// Samples of `truth`, uniform by area, that `least_views` of `views` see, or all if there are no
// views. If few of them are seen, up to 20 times as many are drawn, so that about `samples` count.
// `surface` is the one of `truth`. Error if none is seen.
Places draw_places(const Mesh& truth, const Surface& surface, std::span<const View> views,
                   const PlaceDraw& draw);

// Of the places that `least` to `most` views see.
struct RecallOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: or more
  std::size_t places = 0;
  std::vector<double> recall;  // share of them within each tolerance; 0 where there are none
};

// Exactly `least` views, exactly one more, ... and, from 4 on, all that more see. `distances`: of
// each place to the reconstruction.
std::vector<RecallOfViews> recall_by_views(const Places& places, std::span<const float> distances,
                                           std::span<const double> tolerances, std::uint32_t least);

// Of the places on structures that are so many pixels thick.
struct RecallOfThickness {
  double least = 0, most = 0;  // [px]; both 0: what is not thin; most 0: or more
  std::size_t places = 0;
  std::vector<double> recall;  // as RecallOfViews
};

// `thickness`: of the structure at each vertex of the truth [m], 0 where it is not thin. Its pixels
// are counted where the views that see a place have them, in the mean. Classes in steps of two
// around 1, 2, 4, 8 and 16 pixels, and last what is not thin.
std::vector<RecallOfThickness> recall_by_thickness(const Places& places,
                                                   std::span<const float> distances,
                                                   std::span<const double> tolerances,
                                                   const Mesh& truth, const Surface& surface,
                                                   std::span<const float> thickness,
                                                   std::span<const View> views);

}  // namespace axial::evaluate
