// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: the corner of a square marker, to a small part of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace axial::targets {

struct CornerFit {
  Eigen::Vector2d pixel;       // pixel centres are integers
  Eigen::Matrix2d covariance;  // [px^2]
  double blur = 1;             // [px]
};

// Fits the corner of a black border on a white margin. `corner`: a first guess; `before` and
// `after`: the neighbouring corners of the marker. `cell`: the width of the border and of the
// margin [px]. Pixels whose blur reaches the next cells, and pixels beyond half of
// a side or 40 pixels from the corner, are not used, so that a distorted side may be curved.
// Nothing if these pixels reach over the border of `picture`, if the corner moves by more than a
// cell, or if the pixels do not determine it.
std::optional<CornerFit> fit_corner(const cv::Mat1f& picture, const Eigen::Vector2d& before,
                                    const Eigen::Vector2d& corner, const Eigen::Vector2d& after,
                                    double cell);

}  // namespace axial::targets
