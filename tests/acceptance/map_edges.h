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
// must be `usable`.
std::vector<Crossing> depth_steps(const TrueMap& truth, const cv::Mat1b& usable);

// The edges of a map on crossings. An edge is a maximum of the gradient of the grey level along the
// line, which is smoothed (standard deviation 2 px). The contrast of a line is the largest
// gradient of the true map on it. Only lines with a contrast of at least 6 levels per px count.
struct EdgeCounts {
  std::size_t lines = 0;
  // Lines on which the map has an edge above 0.6 times the contrast where the true map has no edge
  // above a third as much within 2 px.
  std::size_t extra = 0;
  // Lines on whose largest true edge the map has no edge above 0.6 times the contrast within 2 px.
  std::size_t missing = 0;
};
EdgeCounts count_edges(const cv::Mat3b& map, const cv::Mat3b& true_map,
                       const std::vector<Crossing>& crossings);

// The mean of the map and of the map moved by (dx, dy) px.
cv::Mat3b doubled(const cv::Mat3b& map, int dx, int dy);

}  // namespace axial::map_check
