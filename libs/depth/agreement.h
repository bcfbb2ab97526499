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
  int cell = 0;  // cell of the image that contains P's image, 0 to kCellsAcross^2 - 1
};

struct MapAgreement {
  std::vector<PointDifference> points;
  // asked: the number of pixels that are compared with the neighbours. A pixel is compared if its
  // surface point projects to a pixel with a depth in at least two neighbours. consistent: the
  // number of these pixels that at least one neighbour confirms. A neighbour confirms a pixel if
  // the point at the neighbour's depth projects into the map less than one pixel away from the
  // pixel.
  std::size_t asked = 0, consistent = 0;
  std::vector<float> scores;  // the map's confidences at the points; empty if the map has none
};

// Compares a depth map with the sparse `points` [world frame] of its image. Also compares the map,
// at the points' pixels, with the maps of `neighbours`, best first. These pixels represent the map,
// because they have texture. If there are more than `most` points, only `most` of them, at equal
// steps, are used. A point is skipped if it is not finite, if it is outside the image, or if the
// map has no depth at its pixel. MapAgreement::points has an entry for each other point, if a
// neighbour shows both P and S. An empty `map` gives an empty result. Neighbours that are null or
// empty are ignored. The time is proportional to the number of points times the number of
// neighbours.
MapAgreement compare_map(const DepthMap& map, std::span<const DepthMap* const> neighbours,
                         std::span<const Eigen::Vector3f> points, std::size_t most = 1000);

struct Agreement {
  std::size_t points = 0;  // number of PointDifferences
  double share = 0;        // median of PointDifference::share
  double pixels = 0;       // median of |PointDifference::pixels|
  std::size_t cells = 0;   // number of cells with at least 8 points, in all images
  // Median over cells of |median of PointDifference::pixels in the cell| [px]. The noise of single
  // points cancels in the median of a cell.
  double systematic = 0;
  // Median over cells of this quotient: |median of PointDifference::pixels in the cell| divided
  // by the standard error of the median.
  double significance = 0;
  std::size_t asked = 0;   // sum of MapAgreement::asked
  double consistent = 0;   // sum of MapAgreement::consistent divided by `asked`
  std::size_t scored = 0;  // number of MapAgreement::scores
  double score = 0;        // median of MapAgreement::scores
};

// Summarises the results of several maps. Medians of no values are 0.
Agreement summarise(std::span<const MapAgreement> maps);

// Limits beyond which maps disagree. The measurements from which the limits were chosen are in
// docs/formats.md, "Whether cameras and photographs belong together".
struct AgreementLimits {
  double pixels = 0.75, systematic = 0.15, significance = 2, consistent = 0.7;
  // The limit of the score, for photometric maps, whose confidence is 1 - matching cost. If the
  // photographs show nothing of the scene, the maps can stay at the sparse points from which
  // matching starts. They then agree with the points and with each other, but their scores are low.
  double score = 0.65;
  // A limit is not tested if there are too few values: fewer than min_points points (for
  // `pixels`) or scores (for `score`), min_cells cells (for `systematic`), or min_asked pixels
  // asked (for `consistent`).
  std::size_t min_points = 50, min_cells = 8, min_asked = 50;
};

// True for each limit that is exceeded.
struct Disagreement {
  bool pixels = false, systematic = false, consistent = false;
  bool score = false;  // meaningful only for photometric maps, whose confidence is 1 - cost
  bool cameras() const { return pixels || systematic || consistent; }
  bool any() const { return cameras() || score; }
};

// Compares an Agreement with the limits. Agreement::pixels must not be above its limit.
// Agreement::consistent and Agreement::score must not be below their limits.
// Disagreement::systematic is true only if Agreement::systematic and Agreement::significance are
// both above their limits.
Disagreement judge(const Agreement& agreement, const AgreementLimits& limits = {});

}  // namespace axial::depth
