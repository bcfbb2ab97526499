// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/map_pictures.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "view/color_scale.h"
#include "view/little_endian.h"

namespace axial::view {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeastShare = 0.5F;  // of an area that must have values

cv::Mat1f known_share(const cv::Mat1b& known, cv::Size size) {
  cv::Mat1f ones, share;
  known.convertTo(ones, CV_32F, 1 / 255.0);
  cv::resize(ones, share, size, 0, 0, cv::INTER_AREA);
  return share;
}

}  // namespace

cv::Mat3b opaque(const cv::Mat4b& colors) {
  cv::Mat3b picture(colors.size());
  for (int y = 0; y < colors.rows; ++y)
    for (int x = 0; x < colors.cols; ++x) {
      const cv::Vec4b& color = colors(y, x);
      for (int k = 0; k < 3; ++k)
        picture(y, x)[k] = static_cast<std::uint8_t>(
            (color[2 - k] * color[3] + kNothing[2 - k] * (255 - color[3]) + 127) / 255);
    }
  return picture;
}

cv::Mat1b relief(const cv::Mat1f& heights, double width, double height) {
  const Eigen::Vector3d light(-0.5, 0.5, std::sqrt(0.5));
  cv::Mat1b shades(heights.size(), 255);
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x) {
      const float here = heights(y, x);
      const auto at = [&](int row, int column) {
        const float value =
            heights(std::clamp(row, 0, heights.rows - 1), std::clamp(column, 0, heights.cols - 1));
        return static_cast<double>(std::isnan(value) ? here : value);
      };
      const double dx = (at(y, x + 1) - at(y, x - 1)) / (2 * width);
      const double dy = (at(y - 1, x) - at(y + 1, x)) / (2 * height);
      const double cosine = Eigen::Vector3d(-dx, -dy, 1).normalized().dot(light);
      if (!std::isnan(cosine))
        shades(y, x) = static_cast<std::uint8_t>(std::lround(115 + 140 * std::max(cosine, 0.0)));
    }
  return shades;
}

cv::Mat1f reduced_values(const cv::Mat1f& values, cv::Size size) {
  if (size == values.size()) return values;
  cv::Mat1b known;
  cv::compare(values, values, known, cv::CMP_EQ);  // false for NaN
  cv::Mat1f filled = values.clone(), sums;
  filled.setTo(0, ~known);
  cv::resize(filled, sums, size, 0, 0, cv::INTER_AREA);
  const cv::Mat1f share = known_share(known, size);
  cv::Mat1f result(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      result(y, x) = share(y, x) >= kLeastShare ? sums(y, x) / share(y, x) : kMissing;
  return result;
}

HeightData height_data(const cv::Mat1f& heights) {
  constexpr double kSteps = 65534;
  HeightData data;
  double high = 0;
  std::tie(data.low, high) = quantiles(heights, 0, 1);
  data.step = high > data.low ? (high - data.low) / kSteps : 1;
  data.bytes.reserve(2 * heights.total());
  for (const float height : heights) {
    const double steps = std::isnan(height) ? -1 : std::round((height - data.low) / data.step);
    append_u16(data.bytes, static_cast<std::uint16_t>(1 + steps));
  }
  return data;
}

cv::Mat3b normal_picture(const cv::Mat3f& normals, cv::Size size) {
  cv::Mat1b known(normals.size());
  for (int y = 0; y < normals.rows; ++y)
    for (int x = 0; x < normals.cols; ++x)
      known(y, x) = cv::norm(normals(y, x), cv::NORM_L2SQR) > 0 ? 255 : 0;
  cv::Mat3f sums;
  cv::resize(normals, sums, size, 0, 0, cv::INTER_AREA);
  const cv::Mat1f share = known_share(known, size);
  cv::Mat3b picture(size, cv::Vec3b(kNothing[2], kNothing[1], kNothing[0]));
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const cv::Vec3f& sum = sums(y, x);
      const auto length = static_cast<float>(cv::norm(sum));
      if (!(share(y, x) >= kLeastShare) || !(length > 0)) continue;
      for (int k = 0; k < 3; ++k) {
        const float along = (k == 2 ? sum[0] : -sum[2 - k]) / length;  // B G R: -z, -y, x
        picture(y, x)[k] = static_cast<std::uint8_t>(std::lround(127.5F * (1 + along)));
      }
    }
  return picture;
}

}  // namespace axial::view
