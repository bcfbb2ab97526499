// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a plate by a pinhole camera, drawn from the pattern: the oracle of the finder.
#pragma once

#include <Eigen/Dense>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>

#include "targets/codes/pattern.h"

namespace axial::test {

struct PlateView {
  double focal = 900;                               // [px]
  cv::Size size{320, 240};                          // [px]
  Eigen::Vector2d centre{160.3, 119.6};             // image of the plate's centre, COLMAP's pixels
  double width = 40;                                // of the plate seen from the front [px]
  double oblique = 0;                               // between normal and ray [rad]
  double tilt_axis = 0, turn = 0;                   // of the plate [rad]
  double black = 40, white = 200, background = 90;  // brightness
  double blur = 0.6;                                // [px]
  double noise = 2;                                 // standard deviation
  unsigned seed = 1;                                // of the noise
};

// The plate in the camera frame; the plate's centre has the depth 1.
struct PlateFrame {
  Eigen::Vector2d middle;  // of the photograph [px]
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;
  double unit;  // length of the pattern's unit

  PlateFrame(const PlateView& view, const targets::Pattern& pattern)
      : middle(view.size.width / 2.0, view.size.height / 2.0),
        centre(((view.centre - middle) / view.focal).homogeneous()),
        unit(view.width / view.focal / (2 * pattern.half_plate())) {
    const Eigen::AngleAxisd lean(
        view.oblique, Eigen::Vector3d(std::cos(view.tilt_axis), std::sin(view.tilt_axis), 0));
    axes = (lean * Eigen::AngleAxisd(view.turn, Eigen::Vector3d::UnitZ())).toRotationMatrix();
  }
};

// Maps a pixel (COLMAP's convention) to the plane of the pattern.
inline Eigen::Vector2d on_plate(const PlateView& view, const PlateFrame& frame,
                                const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = ((pixel - frame.middle) / view.focal).homogeneous();
  const Eigen::Vector3d normal = frame.axes.col(2);
  const Eigen::Vector3d point = ray * (normal.dot(frame.centre) / normal.dot(ray));
  return (frame.axes.transpose() * (point - frame.centre)).head<2>() / frame.unit;
}

// The image of a point of the plane of the pattern (COLMAP's convention).
inline Eigen::Vector2d image_of(const PlateView& view, const targets::Pattern& pattern,
                                const Eigen::Vector2d& place) {
  const PlateFrame frame(view, pattern);
  const Eigen::Vector3d point =
      frame.centre + frame.axes * Eigen::Vector3d(place.x(), place.y(), 0) * frame.unit;
  return view.focal * point.hnormalized() + frame.middle;
}

// The light from a point of a pixel (COLMAP's convention).
inline double light_at(const PlateView& view, const targets::Pattern& pattern,
                       const PlateFrame& frame, double x, double y) {
  const Eigen::Vector2d place = on_plate(view, frame, {x, y});
  if (place.cwiseAbs().maxCoeff() > pattern.half_plate()) return view.background;
  return pattern.white(place.x(), place.y()) ? view.white : view.black;
}

// The photograph of the plate on a uniform background. The lens blurs before the pixels average.
inline cv::Mat1b photograph(const PlateView& view, const targets::Pattern& pattern) {
  constexpr int kFine = 4, kSamples = 5;  // parts of a pixel, samples of a part, along each side
  const PlateFrame frame(view, pattern);
  cv::Mat1f corners(view.size.height * kFine + 1, view.size.width * kFine + 1);
  const auto near = [&](double x, double y) {
    return (Eigen::Vector2d(x, y) - view.centre).norm() < view.width;
  };
  for (int y = 0; y < corners.rows; ++y)
    for (int x = 0; x < corners.cols; ++x)
      corners(y, x) = static_cast<float>(
          near(x / double{kFine}, y / double{kFine})
              ? light_at(view, pattern, frame, x / double{kFine}, y / double{kFine})
              : view.background);
  cv::Mat1f light(view.size * kFine);
  // Samples on a grid would move edges along the rows by parts of their distance.
  std::mt19937 random(view.seed);
  std::uniform_real_distribution<double> within(0, 1);
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x) {
      const float corner = corners(y, x);
      light(y, x) = corner;
      if (corners(y + 1, x) == corner && corners(y, x + 1) == corner &&
          corners(y + 1, x + 1) == corner)
        continue;
      double sum = 0;
      for (int i = 0; i < kSamples * kSamples; ++i)
        sum +=
            light_at(view, pattern, frame, (x + (i % kSamples + within(random)) / kSamples) / kFine,
                     (y + (i / kSamples + within(random)) / kSamples) / kFine);
      light(y, x) = static_cast<float>(sum / (kSamples * kSamples));
    }
  cv::GaussianBlur(light, light, {}, view.blur * kFine);
  cv::resize(light, light, view.size, 0, 0, cv::INTER_AREA);
  std::normal_distribution<float> noise(0, static_cast<float>(view.noise));
  for (float& value : light) value += noise(random);
  cv::Mat1b result;
  light.convertTo(result, CV_8U);
  return result;
}

}  // namespace axial::test
