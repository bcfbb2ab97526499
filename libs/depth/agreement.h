// SPDX-License-Identifier: GPL-3.0-or-later
// How far depth maps agree with the sparse points and with each other. A port, a lens or a unit
// that is not the photographs' own shows here: points project where the image shows other surface,
// and rays of one surface point do not meet.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "scene/depth_map.h"

namespace axial::depth {

// A part of the image, of which there are kCellsAcross in each direction.
inline constexpr int kCellsAcross = 4;

// A sparse point and the depth map at its image.
struct PointDifference {
  float share = 0;   // |map - point| of the point's depth, along the pixel's ray
  float pixels = 0;  // how far apart a neighbour sees the two; negative: the map is nearer
  int cell = 0;      // where in the image: below kCellsAcross^2
};

struct MapAgreement {
  std::vector<PointDifference> points;
  // Pixels whose surface point lies where the maps of two neighbours or more have a depth, and
  // those of them that a neighbour's depth leads back to within a pixel.
  std::size_t asked = 0, consistent = 0;
  std::vector<float> scores;  // the map's confidence at the points, where it has one
};

// Compares a map with `points` [world], which its image sees, and at their pixels with the maps of
// `neighbours`, best first. Of many points at most `most` are taken, evenly. Points that the map
// has no depth for or no neighbour sees are passed over. The points' pixels stand for the map's
// because they have texture: open water has neither. Linear in points times neighbours.
MapAgreement compare_map(const DepthMap& map, std::span<const DepthMap* const> neighbours,
                         std::span<const Eigen::Vector3f> points, std::size_t most = 1000);

struct Agreement {
  std::size_t points = 0;   // compared
  double share = 0;         // median of PointDifference::share
  double pixels = 0;        // median of |PointDifference::pixels|
  std::size_t cells = 0;    // of all images, with enough points
  double systematic = 0;    // median over cells of |median of pixels| [px]: noise is not in it
  double significance = 0;  // median over cells of that median in its standard errors
  std::size_t asked = 0;
  double consistent = 0;  // share of `asked`
  std::size_t scored = 0;
  double score = 0;  // median of MapAgreement::scores
};

Agreement summarise(std::span<const MapAgreement> maps);

// What is no agreement any more, with the reasons for the numbers beside the measurements in
// docs/formats.md. Fewer points, cells or pixels than these say nothing.
struct AgreementLimits {
  double pixels = 0.75, systematic = 0.15, significance = 2, consistent = 0.7;
  // Of photometric maps, whose confidence is 1 less the matching cost. Where photographs show
  // nothing of the scene at all, maps may keep to the sparse points that they began with and agree.
  double score = 0.65;
  std::size_t min_points = 50, min_cells = 8, min_asked = 50;
};

struct Disagreement {
  bool pixels = false, systematic = false, consistent = false;  // which of the limits is passed
  bool score = false;  // of photometric maps only: other maps' confidences are other numbers
  bool cameras() const { return pixels || systematic || consistent; }
  bool any() const { return cameras() || score; }
};

Disagreement judge(const Agreement& agreement, const AgreementLimits& limits = {});

}  // namespace axial::depth
