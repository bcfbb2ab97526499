// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of hilly ground below five cameras behind flat ports, with sparse points and photographs.
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <random>

#include "scene/any_camera.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::test {

inline constexpr int kWidth = 320, kHeight = 240;

// The height of the ground of a place [m], along -z: cameras look along +z from z = 0.
inline double depth_of_ground(double x, double y, int place) {
  const double turn = 1.7 * place;
  return 1 - 0.09 * std::sin(7 * x + 3 * y + turn) - 0.06 * std::cos(11 * y - 5 * x + 2 * turn);
}

inline Mesh ground(int place, int cells = 60, double size = 1.6) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(size / 2);
  return flipped(height_field(-half, half, static_cast<std::uint32_t>(cells),
                              [&](double x, double y) { return depth_of_ground(x, y, place); }));
}

// The ground of place 0. `points`: number of sparse points.
inline Scene hilly_scene(int points = 600) {
  Scene scene;
  for (int i = 0; i < 5; ++i) {
    SceneImage image;
    image.path = "photo" + std::to_string(i) + ".jpg";
    image.camera = camera_at({0, 0, 0}, kWidth, kHeight, 300, true).camera;
    image.pose.centre = {0.12 * (i - 2), 0.06 * (i % 2), 0};
    scene.images.push_back(image);
  }
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> at(-0.45, 0.45);
  for (int k = 0; k < points; ++k) {
    const double x = at(random), y = at(random);
    SparsePoint point;
    point.position = Eigen::Vector3d(x, y, depth_of_ground(x, y, 0)).cast<float>();
    for (std::uint32_t i = 0; i < 5; ++i) point.views.push_back({i, 1});
    scene.points.push_back(point);
  }
  return scene;
}

// Random values between 0 and 1 at the corners of a grid, interpolated between them.
inline double value_noise(double x, double y) {
  const double i = std::floor(x), j = std::floor(y), a = x - i, b = y - j;
  const auto at = [&](double u, double v) {
    const double wave = 43758.5453 * std::sin(12.9898 * u + 78.233 * v);
    return wave - std::floor(wave);
  };
  return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
         b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
}

// The grey value of the ground.
inline double texture_of_ground(double x, double y) {
  return 30 + 130 * value_noise(80 * x, 80 * y) + 60 * value_noise(31 * x + 0.3, 31 * y);
}

// The photograph of an image of hilly_scene(), by the rays of its camera.
inline cv::Mat1b photograph_of(const SceneImage& image) {
  const AnyCamera<double> camera(make_camera<double>(image.camera));
  cv::Mat1b photograph(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const auto ray = camera.ray({u, v});
      const Eigen::Vector3d from = image.pose.to_world(ray.origin);
      const Eigen::Vector3d along = image.pose.rotation.transpose() * ray.direction;
      Eigen::Vector3d x = from;
      for (int step = 0; step < 12; ++step)  // the ground is level enough that this converges
        x = from + along * (depth_of_ground(x.x(), x.y(), 0) - from.z()) / along.z();
      photograph(v, u) = static_cast<std::uint8_t>(texture_of_ground(x.x(), x.y()));
    }
  return photograph;
}

}  // namespace axial::test
