// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: how well a photograph agrees with the pattern of a target.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>

#include "targets/codes/pattern.h"

namespace axial::targets {

// A place that agrees less with the pattern is not a target.
inline constexpr double kLeastAgreement = 0.8;

// Maps a pixel (centres are integers) to the plane of the pattern.
using ToPattern = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

// Returns the zero-mean normalised cross-correlation (-1 to 1) between `picture` and the pattern,
// blurred by `blur` pixels, over the pixels of `box` whose places in the plane of the pattern are
// within `half` of the origin in x and y. 0 if fewer than 30 pixels are. Large boxes are compared
// at a lower resolution.
double agreement(const cv::Mat1f& picture, const cv::Rect& box, const ToPattern& to_pattern,
                 const Pattern& pattern, double half, double blur);

}  // namespace axial::targets
