// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how well depth maps agree with the sparse points and with each other. A port, a lens or
// a unit that does not belong to the photographs shows in these numbers: points project to pixels
// that show another part of the surface, and the rays of one surface point do not meet.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "scene/depth_map.h"

namespace axial::depth {

// The image is divided into kCellsAcross x kCellsAcross cells.
inline constexpr int kCellsAcross = 4;

// The difference between a sparse point and the surface of the depth map at the point's pixel.
struct PointDifference {
  float share = 0;   // |map's depth - point's depth| / point's depth, along the pixel's ray
  float pixels = 0;  // distance of their images in a neighbour; negative: the map is nearer
  int cell = 0;      // cell of the image, 0 to kCellsAcross^2 - 1
};

struct MapAgreement {
  std::vector<PointDifference> points;
  // asked: the number of pixels whose surface point projects to a depth in the maps of at least two
  // neighbours. consistent: the number of these pixels for which the depth of at least one
  // neighbour, projected back, is less than one pixel away.
  std::size_t asked = 0, consistent = 0;
  std::vector<float> scores;  // the map's confidences at the points; empty if the map has none
};

// Compares a depth map with the sparse `points` of its image [world frame] and, at the points'
// pixels, with the maps of `neighbours`, best first. These pixels represent the map because they
// have texture. Of more than `most` points, `most` at equal steps are used. Points are skipped if
// they are not finite or outside the image, or if the map has no depth at their pixel.
// MapAgreement::points contains the remaining points that a neighbour shows. An empty `map` gives
// an empty result; neighbours that are null or empty are ignored. The time is proportional to the
// number of points times the number of neighbours.
MapAgreement compare_map(const DepthMap& map, std::span<const DepthMap* const> neighbours,
                         std::span<const Eigen::Vector3f> points, std::size_t most = 1000);

struct Agreement {
  std::size_t points = 0;  // number of PointDifferences
  double share = 0;        // median of PointDifference::share
  double pixels = 0;       // median of |PointDifference::pixels|
  std::size_t cells = 0;   // number of cells with at least 8 points, in all images
  // Median over cells of |median of PointDifference::pixels| [px]. Noise cancels in it.
  double systematic = 0;
  // Median over cells of |median of PointDifference::pixels| divided by its standard error.
  double significance = 0;
  std::size_t asked = 0;   // sum of MapAgreement::asked
  double consistent = 0;   // share of `asked` that is consistent
  std::size_t scored = 0;  // number of scores
  double score = 0;        // median of MapAgreement::scores
};

// Summarises the results of several maps. Medians of no values are 0.
Agreement summarise(std::span<const MapAgreement> maps);

// Limits beyond which maps disagree. The measurements behind them are in docs/formats.md, "Whether
// cameras and photographs belong together".
struct AgreementLimits {
  double pixels = 0.75, systematic = 0.15, significance = 2, consistent = 0.7;
  // For photometric maps, whose confidence is 1 - matching cost. If the photographs show nothing of
  // the scene, the maps can stay at the sparse points from which matching starts. They then agree
  // with the points and with each other, but their scores are low.
  double score = 0.65;
  // With fewer points (also: scores), cells or pixels asked, a limit is not tested.
  std::size_t min_points = 50, min_cells = 8, min_asked = 50;
};

// The limits that are exceeded.
struct Disagreement {
  bool pixels = false, systematic = false, consistent = false;
  bool score = false;  // meaningful for photometric maps only; others define confidence differently
  bool cameras() const { return pixels || systematic || consistent; }
  bool any() const { return cameras() || score; }
};

// Compares an Agreement with the limits. `systematic` needs both limits, systematic and
// significance, to be exceeded.
Disagreement judge(const Agreement& agreement, const AgreementLimits& limits = {});

}  // namespace axial::depth
