// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/weak_texture.h"

#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace axial::depth {
namespace {

constexpr int kSide = 9;      // of the matching window
constexpr float kUnit = 255;  // the byte for a confidence of 1

// The sums over all windows, over their parts inside the map. Sums of bytes are exact, whatever the
// order of summation.
cv::Mat1i window_sum(const cv::Mat1b& image) {
  cv::Mat1i sum;
  cv::boxFilter(image, sum, CV_32S, {kSide, kSide}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return sum;
}

// 1 for pixels with a depth that have weak texture or are near a border, otherwise 0.
cv::Mat1b asked_pixels(const DepthMap& map, const cv::Mat1b& grey, const cv::Mat1b& border,
                       float deviation) {
  cv::Mat1f mean, square;
  cv::boxFilter(grey, mean, CV_32F, {kSide, kSide});
  cv::sqrBoxFilter(grey, square, CV_32F, {kSide, kSide});
  cv::Mat1b asked(grey.size(), std::uint8_t{0});
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) {
      const float variance = square(y, x) - mean(y, x) * mean(y, x);
      const bool unsure =
          variance < deviation * deviation || (!border.empty() && border(y, x) != 0);
      if (map.depth(y, x) > 0 && unsure) asked(y, x) = 1;
    }
  return asked;
}

}  // namespace

DepthMap remove_unconfirmed(const DepthMap& map, const cv::Mat1b& grey, const cv::Mat1b& border,
                            const WeakTextureOptions& options) {
  if (grey.size() != map.depth.size())
    fail_in(map.image_path, "the image is {}x{}, but its depth map is {}x{}", grey.cols, grey.rows,
            map.width(), map.height());
  if (map.confidence.empty()) return map;
  const cv::Mat1b asked = asked_pixels(map, grey, border, options.deviation);
  cv::Mat1b confidence(grey.size(), std::uint8_t{0});
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (asked(y, x) != 0)
        confidence(y, x) = cv::saturate_cast<std::uint8_t>(kUnit * map.confidence(y, x));
  const cv::Mat1i count = window_sum(asked), sum = window_sum(confidence);
  const float least = kUnit * options.least_confidence;
  DepthMap result = map;
  result.depth = map.depth.clone();
  result.normal = map.normal.clone();
  result.confidence = map.confidence.clone();
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) {
      const bool confirmed =
          static_cast<float>(sum(y, x)) >= least * static_cast<float>(count(y, x));
      if (asked(y, x) == 0 || confirmed) continue;
      result.depth(y, x) = 0;
      result.confidence(y, x) = 0;
      if (!result.normal.empty()) result.normal(y, x) = {0, 0, 0};
    }
  return result;
}

}  // namespace axial::depth
