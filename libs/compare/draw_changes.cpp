// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/draw_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/order_statistics.h"
#include "compare/height_map.h"
#include "map/overview.h"

namespace axial::compare {
namespace {

constexpr int kLegendHeight = 64, kLegendWidth = 480;  // [px]

// From the colour of small differences to that of large ones, R G B.
struct Scale {
  cv::Vec3d light, dark;
};
const Scale kCameColors{{158, 202, 225}, {8, 48, 107}};
const Scale kGoneColors{{253, 190, 133}, {166, 54, 3}};

// `amount`: 0 to 1.
cv::Vec4b color_of(const Scale& scale, double amount) {
  const cv::Vec3d color = scale.light + std::clamp(amount, 0.0, 1.0) * (scale.dark - scale.light);
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(color[0]), byte(color[1]), byte(color[2]), 255};
}

cv::Vec4b grey_of(const Eigen::Vector2d& slope) {
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
  const double light = std::max(0.0, normal.dot(Eigen::Vector3d(-0.5, 0.5, std::sqrt(0.5))));
  const auto grey = static_cast<std::uint8_t>(std::lround(90 + 150 * light));
  return {grey, grey, grey, 255};
}

// A bar of the colours of a scale, with texts.
void draw_bar(cv::Mat3b& strip, const Scale& scale, int left, const std::string& text) {
  constexpr int kWidth = 120, kTop = 8, kHeight = 16;
  for (int x = 0; x < kWidth; ++x) {
    const cv::Vec4b color = color_of(scale, x / (kWidth - 1.0));
    strip(cv::Rect(left + x, kTop, 1, kHeight)) = cv::Vec3b(color[2], color[1], color[0]);
  }
  cv::putText(strip, text, {left, kTop + kHeight + 18}, cv::FONT_HERSHEY_SIMPLEX, 0.45,
              cv::Scalar(0, 0, 0), 1, cv::LINE_AA);
}

cv::Mat3b legend(int width, double darkest) {
  cv::Mat3b strip(kLegendHeight, width, cv::Vec3b(255, 255, 255));
  const auto words = [&](const char* what) {
    return darkest > 0 ? fmt::format("{}: 0 to {:.3g} mm", what, darkest * 1000)
                       : fmt::format("{}: nothing", what);
  };
  draw_bar(strip, kCameColors, 16, words("came"));
  draw_bar(strip, kGoneColors, 180, words("gone"));
  const Scale grey{{210, 210, 210}, {210, 210, 210}};
  draw_bar(strip, grey, 344, "not changed");
  return strip;
}

// Pixels are taken from the middle of the pixels of the reduced map.
cv::Mat4b map_colors(const Comparison& comparison, int stride, double darkest) {
  const cv::Mat1b& classes = comparison.changes.classes;
  cv::Mat4b colors((classes.rows + stride - 1) / stride, (classes.cols + stride - 1) / stride,
                   cv::Vec4b(0, 0, 0, 0));
  for (int v = 0; v < colors.rows; ++v)
    for (int u = 0; u < colors.cols; ++u) {
      const int y = std::min(v * stride + stride / 2, classes.rows - 1);
      const int x = std::min(u * stride + stride / 2, classes.cols - 1);
      const std::uint8_t kind = classes(y, x);
      if (kind == kNotCompared) continue;
      const double amount =
          std::abs(static_cast<double>(comparison.difference(y, x))) / std::max(darkest, 1e-12);
      colors(v, u) = kind == kUnchanged
                         ? grey_of(slope_at(comparison.before, y, x, comparison.grid.pixel))
                         : color_of(kind == kCame ? kCameColors : kGoneColors, amount);
    }
  return colors;
}

}  // namespace

double darkest_difference(const Comparison& comparison) {
  std::vector<float> values;
  for (int y = 0; y < comparison.difference.rows; ++y)
    for (int x = 0; x < comparison.difference.cols; ++x) {
      const std::uint8_t kind = comparison.changes.classes(y, x);
      if (kind == kCame || kind == kGone) values.push_back(std::abs(comparison.difference(y, x)));
    }
  const std::size_t place = values.size() * 98 / 100;
  return values.empty() ? 0 : static_cast<double>(value_at_place(std::move(values), place));
}

cv::Mat3b draw_changes(const Comparison& comparison, bool is_georeferenced, int longest_side) {
  const int longest = std::max(comparison.grid.columns, comparison.grid.rows);
  const int stride = std::max(1, (longest + longest_side - 1) / longest_side);
  const double darkest = darkest_difference(comparison);
  const cv::Mat3b map = map::draw_overview(map_colors(comparison, stride, darkest),
                                           {comparison.grid.pixel * stride, is_georeferenced});
  const int width = std::max(map.cols, kLegendWidth);
  cv::Mat3b picture(map.rows + kLegendHeight, width, cv::Vec3b(255, 255, 255));
  map.copyTo(picture(cv::Rect(0, 0, map.cols, map.rows)));
  legend(width, darkest).copyTo(picture(cv::Rect(0, map.rows, width, kLegendHeight)));
  return picture;
}

}  // namespace axial::compare
