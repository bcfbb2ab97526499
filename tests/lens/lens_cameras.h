// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP cameras with given distortion, for the tests of lenses.
#pragma once

#include <rapidcheck.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/colmap/colmap_lens.h"
#include "lens/lens.h"

namespace axial::lens {

inline constexpr double kFx = 700, kFy = 650, kCx = 330.5, kCy = 236.5;  // pixel centres at 0.5

inline io::ColmapCamera two_focal_camera(const std::string& model, std::vector<double> distortion) {
  io::ColmapCamera camera{1, model, 640, 480, {kFx, kFy, kCx, kCy}};
  camera.params.insert(camera.params.end(), distortion.begin(), distortion.end());
  return camera;
}

inline io::ColmapCamera one_focal_camera(const std::string& model, std::vector<double> distortion) {
  io::ColmapCamera camera{1, model, 640, 480, {kFx, kCx, kCy}};
  camera.params.insert(camera.params.end(), distortion.begin(), distortion.end());
  return camera;
}

inline cv::Matx33d opencv_k() {
  return {kFx, 0, kCx - 0.5, 0, kFy, kCy - 0.5, 0, 0, 1};
}

inline double within(double limit) {
  return limit * (static_cast<double>(*rc::gen::inRange(-1000000, 1000001)) / 1e6);
}

// The distorted point before focal lengths and principal point are applied.
inline Eigen::Vector2d distorted(const io::ColmapCamera& camera, double u, double v) {
  const Eigen::Vector2d pixel = image_direction(io::lens_of(camera), u, v);
  const bool one = camera.params.size() == 4 || camera.params.size() == 3;
  return {(pixel.x() - (kCx - 0.5)) / kFx, (pixel.y() - (kCy - 0.5)) / (one ? kFx : kFy)};
}

}  // namespace axial::lens
