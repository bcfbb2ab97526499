// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a painted plane, made by intersecting the rays of every pixel with the plane.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <variant>

#include "axial/scene.h"
#include "scene/camera_model.h"

namespace axial::test {

// Renders the plane z = 0 of the world. `paint(x, y)`: brightness of the plane at (x, y), 0 to 1. A
// pixel is the mean of 3 x 3 rays. If the four rays at the corners of this grid have the same
// brightness, the pixel gets this brightness.
template <class Paint>
cv::Mat1b photograph(const CameraModel& model, const Pose& pose, const Paint& paint) {
  constexpr int kSide = 3;
  cv::Mat1b image(model.height, model.width);
  std::visit(
      [&](const auto& camera) {
        const auto brightness = [&](double u, double v) {
          const auto ray = camera.ray({u, v});
          const Eigen::Vector3d origin = pose.to_world(ray.origin);
          const Eigen::Vector3d direction = pose.rotation.transpose() * ray.direction;
          const Eigen::Vector3d hit = origin - direction * (origin.z() / direction.z());
          return paint(hit.x(), hit.y());
        };
        for (int y = 0; y < model.height; ++y)
          for (int x = 0; x < model.width; ++x) {
            const auto at = [&](int k) {
              return brightness(x + (k % kSide + 0.5) / kSide - 0.5,
                                y + (k / kSide + 0.5) / kSide - 0.5);
            };
            const double first = at(0);
            double sum = first * kSide * kSide;
            if (at(2) != first || at(6) != first || at(8) != first) {
              sum = 0;
              for (int k = 0; k < kSide * kSide; ++k) sum += at(k);
            }
            image(y, x) =
                cv::saturate_cast<unsigned char>(std::round(20 + 200 * sum / (kSide * kSide)));
          }
      },
      make_camera<double>(model));
  return image;
}

// Returns the brightness of a checkerboard with columns x rows inner corners. The inner corners lie
// at multiples of `square`, from (0, 0) on. The board has a white margin of one square and lies on
// grey ground.
inline auto checkerboard(int columns, int rows, double square) {
  return [=](double x, double y) {
    const double column = std::floor(x / square), row = std::floor(y / square);
    if (column < -2 || row < -2 || column > columns || row > rows) return 0.4;
    if (column < -1 || row < -1 || column > columns - 1 || row > rows - 1) return 1.0;
    return std::fmod(std::abs(column + row), 2) == 0 ? 0.0 : 1.0;
  };
}

// Returns the brightness of a picture that covers the plane from (0, 0) to (width, height). The
// plane is white outside of the picture.
inline auto picture(const cv::Mat1b& pixels, double width, double height) {
  return [=](double x, double y) {
    const int column = static_cast<int>(std::floor(x / width * pixels.cols));
    const int row = static_cast<int>(std::floor(y / height * pixels.rows));
    const bool inside = column >= 0 && row >= 0 && column < pixels.cols && row < pixels.rows;
    return inside ? pixels(row, column) / 255.0 : 1.0;
  };
}

}  // namespace axial::test
