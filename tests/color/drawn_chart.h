// SPDX-License-Identifier: GPL-3.0-or-later
// A colour chart of 24 patches, drawn.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "color/chart.h"

namespace axial::color::test {

// The middle of a patch of a chart of 6.7 x 4.5 (patches of 1, gaps of 0.1).
inline cv::Point2d middle_of_patch(std::size_t patch) {
  return {0.6 + 1.1 * static_cast<double>(patch % 6), 0.6 + 1.1 * static_cast<double>(patch / 6)};
}

// Draws the chart with its frame of albedo 0.02 into `light` (linear R G B). `to_image`: a
// homography from the chart's coordinates to pixels.
inline void draw_chart(const cv::Matx33d& to_image, cv::Mat3f& light) {
  constexpr int kUnit = 100;
  cv::Mat3f chart(450, 670, cv::Vec3f(0.02f, 0.02f, 0.02f));
  const auto colors = chart_colors();
  for (std::size_t i = 0; i < kPatches; ++i) {
    const cv::Point2d middle = middle_of_patch(i) * kUnit;
    chart(cv::Rect(static_cast<int>(middle.x) - kUnit / 2, static_cast<int>(middle.y) - kUnit / 2,
                   kUnit, kUnit)) = cv::Vec3f(colors[i][0], colors[i][1], colors[i][2]);
  }
  // Pixels of the enlarged chart to its coordinates: pixel centres are whole numbers here.
  const cv::Matx33d from_pixels(1.0 / kUnit, 0, 0.5 / kUnit, 0, 1.0 / kUnit, 0.5 / kUnit, 0, 0, 1);
  // Means over 4 x 4 places in a pixel: the chart is reduced.
  constexpr int kFiner = 4;
  const cv::Matx33d finer(kFiner, 0, (kFiner - 1) / 2.0, 0, kFiner, (kFiner - 1) / 2.0, 0, 0, 1);
  cv::Mat3f fine;
  cv::resize(light, fine, {}, kFiner, kFiner, cv::INTER_NEAREST);
  cv::warpPerspective(chart, fine, cv::Mat(finer * to_image * from_pixels), fine.size(),
                      cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  cv::resize(fine, light, light.size(), 0, 0, cv::INTER_AREA);
}

// The homography of a chart with its middle at `centre` [px], of this length [px], turned by
// `degrees`, and seen from the side by `tilt` (0: straight).
inline cv::Matx33d place_chart(const cv::Point2d& centre, double length, double degrees,
                               double tilt) {
  const double angle = degrees * CV_PI / 180, scale = length / 6.7;
  const cv::Matx33d to_middle(1, 0, -3.35, 0, 1, -2.25, 0, 0, 1);
  const cv::Matx33d turned(scale * std::cos(angle), -scale * std::sin(angle), 0,
                           scale * std::sin(angle), scale * std::cos(angle), 0, tilt / 6.7, 0, 1);
  return cv::Matx33d(1, 0, centre.x, 0, 1, centre.y, 0, 0, 1) * turned * to_middle;
}

inline cv::Point2d mapped(const cv::Matx33d& map, const cv::Point2d& point) {
  const cv::Vec3d to = map * cv::Vec3d(point.x, point.y, 1);
  return {to[0] / to[2], to[1] / to[2]};
}

}  // namespace axial::color::test
