// SPDX-License-Identifier: GPL-3.0-or-later
// Coded targets as they were measured in photographs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace axial::pose {

// A target in a photograph, as it was measured. Pixels are pixels of the photograph, with centres
// at integers.
struct TargetImage {
  std::size_t image = 0;  // index into Bundle::images
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma = 0;  // standard deviation of each coordinate [px]; 0: not known
  // Ring: the symmetric matrix [1/px] that maps the ellipse of the dot, with its centre at `pixel`,
  // to the unit circle. Zero: no ring.
  Eigen::Matrix2d dot = Eigen::Matrix2d::Zero();
  // Square: the corners; `pixel` is the intersection of the diagonals.
  std::optional<std::array<Eigen::Vector2d, 4>> corners = {};
};

struct Target {
  std::string label;
  std::vector<TargetImage> images;
  std::size_t source = 0;  // BundlePoint::source of its point; add_targets() sets it
};

}  // namespace axial::pose
