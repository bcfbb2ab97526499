// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: places of a photograph that look like a corner of a checkerboard.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace axial::calibrate {

// The radius [px] of the circle around a saddle on which its edges are measured. The squares of a
// board must be about twice as wide.
inline constexpr int kSaddleRadius = 4;

// A point in which two edges cross, so that the brightness around the point alternates twice
// between dark and bright.
struct Saddle {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  // The unit directions of both edges, each up to its sign. If the direction turns from x towards
  // y, the brightness rises at the first edge, and falls at the second one.
  std::array<Eigen::Vector2d, 2> edges;
  double contrast = 0;  // bright minus dark [grey levels]
};

// Returns the saddles of a photograph with grey levels from 0 to 255, the ones with the most
// contrast first, and at most `most` saddles. `smooth`: the photograph without noise of single
// pixels. The pixels of saddles are whole numbers.
std::vector<Saddle> find_saddles(const cv::Mat1f& smooth, std::size_t most);

}  // namespace axial::calibrate
