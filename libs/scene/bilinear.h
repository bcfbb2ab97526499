// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <opencv2/core.hpp>

namespace axial {

// The colour (B G R) at the position `at` (x, y) [px], interpolated bilinearly between pixel
// centres at integers. A position beyond the outermost pixel centres is moved to the nearest
// position between them. Precondition: `image` is not empty.
inline Eigen::Vector3f bilinear(const cv::Mat3b& image, const Eigen::Vector2f& at) {
  const float x = std::clamp(at.x(), 0.0f, static_cast<float>(image.cols - 1));
  const float y = std::clamp(at.y(), 0.0f, static_cast<float>(image.rows - 1));
  const int i = std::max(0, std::min(static_cast<int>(x), image.cols - 2));
  const int j = std::max(0, std::min(static_cast<int>(y), image.rows - 2));
  const int next = image.cols > 1 ? 1 : 0, below = image.rows > 1 ? 1 : 0;
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const auto pixel = [&](int row, int column) {
    const cv::Vec3b& p = image(row, column);
    return Eigen::Vector3f(p[0], p[1], p[2]);
  };
  return (1 - b) * ((1 - a) * pixel(j, i) + a * pixel(j, i + next)) +
         b * ((1 - a) * pixel(j + below, i) + a * pixel(j + below, i + next));
}

}  // namespace axial
