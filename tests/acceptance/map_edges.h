// SPDX-License-Identifier: GPL-3.0-or-later
// Counts doubled edges of orthomosaics at the silhouettes of rocks, for map_check.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "map_truth.h"

namespace axial::map_check {

// A line in a map across a depth step.
struct Crossing {
  cv::Point2f middle, direction;  // pixel coordinates (centres at integers); unit
};

// The crossings of a true map: lines of 12 px to both sides of each pixel between whose neighbours
// the height differs by more than 50 mm per px, along the steepest height. All pixels of the line
// must be `usable`, and at least 3 px of it `wrong` in a map without visibility: there such a map
// shows the rock a second time.
std::vector<Crossing> depth_steps(const TrueMap& truth, const cv::Mat1b& usable,
                                  const cv::Mat1b& wrong);

// The edges of a map on crossings. An edge is a maximum of the gradient of the grey level along the
// line, which is smoothed (standard deviation 1.5 px). Only lines on which the largest edge of the
// true map has at least 6 levels per px count.
struct EdgeCounts {
  std::size_t lines = 0;
  // Lines on which the map shows the largest true edge within 2 px, and in addition an edge where
  // the true map has none within 2 px. Edges of the map count above 0.6 times its largest one, and
  // true edges above a fifth of the largest one.
  std::size_t doubled = 0;
};
EdgeCounts count_edges(const cv::Mat3b& map, const cv::Mat3b& true_map,
                       const std::vector<Crossing>& crossings);

// The mean of the map and of the map moved by (dx, dy) px.
cv::Mat3b doubled(const cv::Mat3b& map, int dx, int dy);

}  // namespace axial::map_check
