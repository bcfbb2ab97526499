// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace axial::map {
namespace {

constexpr int kStrip = 56, kLeastWidth = 200;  // [px]
const cv::Scalar kInk(0, 0, 0);

std::string words_of(double metres) {
  if (metres >= 1000) return fmt::format("{:g} km", metres / 1000);
  if (metres >= 1) return fmt::format("{:g} m", metres);
  if (metres >= 0.01) return fmt::format("{:g} cm", std::round(metres * 1000) / 10);
  return fmt::format("{:g} mm", std::round(metres * 1e6) / 1000);
}

void draw_scale_bar(cv::Mat3b& picture, int top, double pixel) {
  const double length = scale_bar_length(picture.cols * pixel);
  const int width = std::max(1, static_cast<int>(std::lround(length / pixel)));
  constexpr int kLeft = 16;
  cv::rectangle(picture, {kLeft, top + 34, width, 8}, kInk, cv::FILLED);
  if (width > 8)
    cv::rectangle(picture, {kLeft + width / 2, top + 36, width - width / 2 - 2, 4},
                  cv::Scalar(255, 255, 255), cv::FILLED);
  cv::putText(picture, words_of(length), {kLeft, top + 26}, cv::FONT_HERSHEY_SIMPLEX, 0.55, kInk, 1,
              cv::LINE_AA);
}

void draw_arrow(cv::Mat3b& picture, int top, const std::string& letter) {
  const int x = picture.cols - 28;
  cv::arrowedLine(picture, {x, top + 48}, {x, top + 8}, kInk, 2, cv::LINE_AA, 0, 0.3);
  cv::putText(picture, letter, {x - 24, top + 34}, cv::FONT_HERSHEY_SIMPLEX, 0.6, kInk, 2,
              cv::LINE_AA);
}

}  // namespace

double scale_bar_length(double width) {
  const double most = width / 3;
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * power <= most) return step * power;
  return power;
}

cv::Mat3b draw_overview(const cv::Mat4b& colors, const OverviewFacts& facts) {
  cv::Mat3b picture(colors.rows + kStrip, std::max(colors.cols, kLeastWidth),
                    cv::Vec3b(255, 255, 255));
  for (int y = 0; y < colors.rows; ++y)
    for (int x = 0; x < colors.cols; ++x) {
      const cv::Vec4b& color = colors(y, x);
      for (int k = 0; k < 3; ++k)
        picture(y, x)[k] = static_cast<std::uint8_t>(
            (color[2 - k] * color[3] + 255 * (255 - color[3]) + 127) / 255);
    }
  draw_scale_bar(picture, colors.rows, facts.pixel);
  draw_arrow(picture, colors.rows, facts.is_georeferenced ? "N" : "y");
  return picture;
}

}  // namespace axial::map
