// SPDX-License-Identifier: GPL-3.0-or-later
// Places: samples of the true surface that the cameras see. Recall: the share of the places whose
// distance from a reconstruction is at most a tolerance. Recall is computed by the number of views
// that see a place, and by the thickness of the structure to which a place belongs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "evaluate/views.h"
#include "geometry/surface.h"
#include "scene/mesh.h"

namespace axial::evaluate {

// Places, drawn by draw_places(). All arrays have one element for each place. Exception: `views` is
// empty if the places were drawn without views.
struct Places {
  std::vector<Eigen::Vector3f> positions;  // [m], in the frame of the truth
  std::vector<std::uint32_t> faces;        // indices of the faces of the truth on which they lie
  std::vector<std::uint32_t> views;        // number of views that see each place (count_views)
  // Number of samples that draw_places() drew, kept or not. If it drew twice: of the second draw.
  std::size_t drawn = 0;

  // The number of places.
  std::size_t size() const { return positions.size(); }
};

struct PlaceDraw {
  std::size_t samples = 200000;   // wanted number of places; at least 1
  std::uint64_t seed = 1;         // of the random samples
  std::uint32_t least_views = 2;  // a sample is a place if at least this number of views see it
};

// Draws `draw.samples` samples of `truth`, uniform by area. Keeps the samples that at least
// `draw.least_views` of `views` see. If `views` is empty, all samples are kept. If at most half of
// the samples are kept, the draw is repeated once with more samples, so that about `draw.samples`
// are kept. The repeated draw has at most 20 * draw.samples samples, so fewer may be kept.
// Precondition: `surface` is made from `truth`. Error if there are views but no sample is kept, or
// as for geometry::sample_surface().
Places draw_places(const Mesh& truth, const geometry::Surface& surface, std::span<const View> views,
                   const PlaceDraw& draw);

// Recall of the places that `least` to `most` views see.
struct RecallOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: no upper limit
  std::size_t places = 0;             // number of places in the class
  // For each tolerance, the share of the places of the class whose distance is at most the
  // tolerance; 0 without places.
  std::vector<double> recall;
};

// Returns the recall by the number of views that see a place, in ascending order. If `least` is
// below 4, there is one class for each of the numbers `least` to 3, and a last class for 4 or more
// views. Otherwise the only class is `least` or more views. Places that fewer than `least` views
// see are in no class. `distances`: from each place to the reconstruction [m], in the order of
// `places`. `tolerances`: [m]. Precondition: `places` are drawn with views.
std::vector<RecallOfViews> recall_by_views(const Places& places, std::span<const float> distances,
                                           std::span<const double> tolerances, std::uint32_t least);

// Recall of the places on thin structures whose thickness [px] is in [least, most). If only `most`
// is 0, there is no upper limit. If both are 0, these are the places that are not on thin
// structures.
struct RecallOfThickness {
  double least = 0, most = 0;  // [px]
  std::size_t places = 0;      // number of places in the class
  // For each tolerance, the share of the places of the class whose distance is at most the
  // tolerance; 0 without places.
  std::vector<double> recall;
};

// Returns the recall by thickness of the structure, in seven classes. Let s = sqrt(2). The classes
// are, in this order [px]: [0, s), [s, 2s), [2s, 4s), [4s, 8s), [8s, 16s), 16s and more, and last
// the places that are not thin.
//
// `thickness`: thickness of the structure [m] at each vertex of `truth`, 0 where the structure is
// not thin. The thickness of a place is the mean over the three vertices of its face. A place is
// not thin if one of these vertices has thickness 0. The thickness in pixels is the thickness in
// metres divided by the width of a pixel at the place (pixel_widths() with `views` and `surface`).
// A thin place that no view sees is in the class of 16s and more. `distances`: from each place to
// the reconstruction [m], in the order of `places`. `tolerances`: [m]. Preconditions: `places` are
// drawn from `truth`, and `surface` is made from `truth`. Error if the number of values in
// `thickness` is not the number of vertices.
std::vector<RecallOfThickness> recall_by_thickness(
    const Places& places, std::span<const float> distances, std::span<const double> tolerances,
    const Mesh& truth, const geometry::Surface& surface, std::span<const float> thickness,
    std::span<const View> views);

}  // namespace axial::evaluate
