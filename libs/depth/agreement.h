// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how well depth maps agree with the sparse points and with each other. A port, a lens or
// a unit that does not belong to the photographs makes these numbers worse: sparse points project
// to pixels that show another part of the surface, and the rays of one surface point do not meet.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "scene/depth_map.h"

namespace axial::depth {

// The image is divided into kCellsAcross x kCellsAcross cells.
inline constexpr int kCellsAcross = 4;

// The difference between a sparse point P and the depth map of an image that sees P. Take the ray
// of the pixel position to which P projects, and let S be the point on this ray at the depth that
// the map has at the nearest pixel. Depths are measured along this ray.
struct PointDifference {
  float share = 0;  // |depth of S - depth of P| / depth of P
  // Distance [px] between the images of P and S in the first neighbouring view that shows both.
  // Negative if S is nearer to the camera than P.
  float pixels = 0;
  int cell = 0;  // index of the cell that contains P's image, row by row from 0
};

// The result of compare_map() for one map. P and S are the points of PointDifference.
struct MapAgreement {
  // One entry for each used point P for which a neighbour shows both P and S.
  std::vector<PointDifference> points;
  // asked: the number of points S that are compared with the neighbours. S is compared if it
  // projects to a pixel with a depth in at least two neighbours. consistent: the number of compared
  // points S that at least one neighbour confirms. For this test, take the neighbour's ray through
  // the image of S, and the point on this ray at the depth that the neighbour's map has at the
  // nearest pixel. The neighbour confirms S if this point projects into the map less than one pixel
  // away from the image of P.
  std::size_t asked = 0, consistent = 0;
  // The map's confidences at the images of all used points P. Empty if the map has no confidences.
  std::vector<float> scores;
};

// Compares a depth map with the sparse `points` [world frame] of its image, and with the maps of
// `neighbours`, best first. Both comparisons are made only at the images of the points. These
// pixels represent the map, because they have texture.
//
// If there are more than `most` points, only `most` of them, at equal steps, are taken. Of these
// points, a point is used if it is finite and inside the image, and if the map has a depth at the
// nearest pixel. The results are in the order of `points`. An empty `map` gives an empty result.
// Neighbours that are null or empty are ignored. The time is proportional to the number of points
// times the number of neighbours.
MapAgreement compare_map(const DepthMap& map, std::span<const DepthMap* const> neighbours,
                         std::span<const Eigen::Vector3f> points, std::size_t most = 1000);

// The results of several maps together. The median of an even number of values is the upper of the
// two values in the middle.
struct Agreement {
  std::size_t points = 0;  // number of PointDifferences
  double share = 0;        // median of PointDifference::share
  double pixels = 0;       // median of |PointDifference::pixels| [px]
  std::size_t cells = 0;   // number of cells with at least 8 points, in all images
  // Median over these cells of |median of PointDifference::pixels in the cell| [px]. The noise of
  // single points cancels in the median of a cell.
  double systematic = 0;
  // Median over these cells of this quotient: |median of PointDifference::pixels in the cell|
  // divided by the standard error of the median.
  double significance = 0;
  std::size_t asked = 0;   // sum of MapAgreement::asked
  double consistent = 0;   // sum of MapAgreement::consistent divided by `asked`
  std::size_t scored = 0;  // number of MapAgreement::scores
  double score = 0;        // median of MapAgreement::scores
};

// Summarises the results of several maps. Medians and shares of no values are 0.
Agreement summarise(std::span<const MapAgreement> maps);

// Limits beyond which maps disagree. Each limit is for the field of Agreement with the same name
// and has its unit. The measurements from which the limits were chosen are in docs/formats.md,
// "Whether cameras and photographs belong together".
struct AgreementLimits {
  double pixels = 0.75, systematic = 0.15, significance = 2, consistent = 0.7;
  // The limit of the score, for photometric maps, whose confidence is 1 - matching cost. If the
  // photographs show nothing of the scene, the maps can stay at the sparse points from which
  // matching starts. They then agree with the points and with each other, but their scores are low.
  double score = 0.65;
  // A limit is not tested if there are too few values: for `pixels` fewer than min_points points,
  // for `score` fewer than min_points scores, for `systematic` fewer than min_cells cells, or for
  // `consistent` fewer than min_asked compared points (Agreement::asked).
  std::size_t min_points = 50, min_cells = 8, min_asked = 50;
};

// The result of judge(). A field is true if the quantity with its name is beyond its limit.
struct Disagreement {
  bool pixels = false, systematic = false, consistent = false;
  bool score = false;  // meaningful only for photometric maps, whose confidence is 1 - cost
  // True if a test fails that depends on the cameras.
  bool cameras() const { return pixels || systematic || consistent; }
  bool any() const { return cameras() || score; }
};

// Compares an Agreement with the limits. In the result, `pixels` is true if Agreement::pixels is
// above its limit. `consistent` and `score` are true if the fields of Agreement with these names
// are below their limits. `systematic` is true if Agreement::systematic and Agreement::significance
// are both above their limits. A field is false if there are too few values for its test.
Disagreement judge(const Agreement& agreement, const AgreementLimits& limits = {});

}  // namespace axial::depth
