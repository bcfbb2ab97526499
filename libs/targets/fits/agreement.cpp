// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/fits/agreement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace axial::targets {
namespace {

constexpr int kFineSamples = 3;  // of the pattern, along each side of a pixel
constexpr int kLargest = 96;     // side of the compared picture [px]

// Correlation of two pictures where `mask` is set.
double correlation(const cv::Mat1f& a, const cv::Mat1f& b, const cv::Mat1b& mask) {
  if (cv::countNonZero(mask) < 30) return 0;
  cv::Scalar mean_a, mean_b, spread_a, spread_b;
  cv::meanStdDev(a, mean_a, spread_a, mask);
  cv::meanStdDev(b, mean_b, spread_b, mask);
  if (spread_a[0] <= 0 || spread_b[0] <= 0) return 0;
  cv::Mat1f product;
  cv::multiply(a, b, product);
  return (cv::mean(product, mask)[0] - mean_a[0] * mean_b[0]) / (spread_a[0] * spread_b[0]);
}

}  // namespace

double agreement(const cv::Mat1f& picture, const cv::Rect& box, const ToPattern& to_pattern,
                 const Pattern& pattern, double half, double blur) {
  const cv::Rect seen = box & cv::Rect(0, 0, picture.cols, picture.rows);
  if (seen.empty()) return 0;
  const double shrink = std::max(1.0, std::max(seen.width, seen.height) / double{kLargest});
  const cv::Size size(std::max(1, static_cast<int>(seen.width / shrink)),
                      std::max(1, static_cast<int>(seen.height / shrink)));
  cv::Mat1f there;
  cv::resize(picture(seen), there, size, 0, 0, cv::INTER_AREA);
  cv::Mat1f drawn(size.height * kFineSamples, size.width * kFineSamples);
  cv::Mat1b mask(size, std::uint8_t{255});
  const double step_x = static_cast<double>(seen.width) / drawn.cols;
  const double step_y = static_cast<double>(seen.height) / drawn.rows;
  for (int y = 0; y < drawn.rows; ++y)
    for (int x = 0; x < drawn.cols; ++x) {
      const Eigen::Vector2d place =
          to_pattern({seen.x - 0.5 + (x + 0.5) * step_x, seen.y - 0.5 + (y + 0.5) * step_y});
      drawn(y, x) = pattern.white(place.x(), place.y()) ? 1.0f : 0.0f;
      if (place.cwiseAbs().maxCoeff() > half) mask(y / kFineSamples, x / kFineSamples) = 0;
    }
  const double sigma = std::max(0.3, blur / shrink) * kFineSamples;
  cv::GaussianBlur(drawn, drawn, {}, sigma, sigma, cv::BORDER_REPLICATE);
  cv::resize(drawn, drawn, size, 0, 0, cv::INTER_AREA);
  return correlation(there, drawn, mask);
}

}  // namespace axial::targets
