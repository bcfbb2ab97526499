// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture/dmap_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/images/image.h"

namespace axial::picture {
namespace {

// Scales the values above 0 to 1 .. 255. The lowest and highest hundredth are clamped. 0 where
// there is no value.
cv::Mat1b levels_of(const cv::Mat1f& values) {
  std::vector<float> sorted;
  for (const float value : values)
    if (value > 0) sorted.push_back(value);
  std::sort(sorted.begin(), sorted.end());
  cv::Mat1b levels(values.size(), std::uint8_t{0});
  if (sorted.empty()) return levels;
  const float low = sorted[sorted.size() / 100],
              high = sorted[sorted.size() - 1 - sorted.size() / 100];
  const float scale = high > low ? 254 / (high - low) : 0;
  std::transform(values.begin(), values.end(), levels.begin(), [&](float value) {
    const float level = 1 + scale * (std::clamp(value, low, high) - low);
    return value > 0 ? static_cast<std::uint8_t>(std::lround(level)) : std::uint8_t{0};
  });
  return levels;
}

cv::Mat3b depth_picture(const cv::Mat1f& depth) {
  cv::Mat3b picture;
  cv::applyColorMap(levels_of(depth), picture, cv::COLORMAP_VIRIDIS);
  picture.setTo(cv::Scalar::all(0), depth <= 0);
  return picture;
}

cv::Mat3b normal_picture(const cv::Mat3f& normals) {
  cv::Mat3b picture(normals.size(), cv::Vec3b(0, 0, 0));
  const auto level = [](float value) {
    return cv::saturate_cast<std::uint8_t>(127.5f * (1 + value));
  };
  std::transform(normals.begin(), normals.end(), picture.begin(), [&](const cv::Vec3f& n) {
    return n == cv::Vec3f(0, 0, 0) ? cv::Vec3b(0, 0, 0)
                                   : cv::Vec3b(level(-n[2]), level(n[1]), level(n[0]));
  });
  return picture;
}

}  // namespace

void write_dmap_pictures(const std::filesystem::path& dmap, const DepthMap& map) {
  const auto beside = [&](const char* extension) {
    std::filesystem::path path = dmap;
    return path.replace_extension(extension);
  };
  io::write_png(beside(".png"), depth_picture(map.depth));
  io::write_png(beside(".normal.png"), normal_picture(map.normal));
  if (!map.confidence.empty()) io::write_png(beside(".confidence.png"), levels_of(map.confidence));
}

}  // namespace axial::picture
