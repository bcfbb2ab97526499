// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/resolution.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace axial {
namespace {

int working_side(int longest, const ResolutionOptions& options) {
  if (options.level == 0) return std::min(longest, options.max);
  const auto halved = [&](unsigned level) { return level < 31 ? longest >> level : 0; };
  unsigned level = options.level;
  while (level > 0 && halved(level) < options.min) --level;
  return std::min(halved(level), options.max);
}

void require_not_empty(const cv::Mat& image, cv::Size size) {
  if (image.empty()) fail("resize: the image is empty");
  if (size.width < 1 || size.height < 1) fail("resize: size is {}x{}", size.width, size.height);
}

}  // namespace

cv::Size working_size(int width, int height, const ResolutionOptions& options) {
  if (width < 1 || height < 1) fail("image size is {}x{}", width, height);
  if (options.max < 1) fail("max-resolution is {}", options.max);
  const int longest = std::max(width, height);
  const double scale = static_cast<double>(working_side(longest, options)) / longest;
  const auto scaled = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(side * scale)));
  };
  return {scaled(width), scaled(height)};
}

bool same_shape(cv::Size a, cv::Size b) {
  const int shortest = std::min({a.width, a.height, b.width, b.height});
  if (shortest < 1) return false;
  const double ratio = static_cast<double>(a.width) / a.height * b.height / b.width;
  return std::abs(ratio - 1) <= 1.5 / shortest;
}

cv::Mat3b resized_image(const cv::Mat3b& image, cv::Size size) {
  require_not_empty(image, size);
  if (image.size() == size) return image;
  const bool shrinks = size.width <= image.cols && size.height <= image.rows;
  cv::Mat3b result;
  cv::resize(image, result, size, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
  return result;
}

cv::Mat1w resized_labels(const cv::Mat1w& labels, cv::Size size) {
  require_not_empty(labels, size);
  if (labels.size() == size) return labels;
  cv::Mat1w result;
  cv::resize(labels, result, size, 0, 0, cv::INTER_NEAREST_EXACT);
  return result;
}

}  // namespace axial
