// SPDX-License-Identifier: GPL-3.0-or-later
// A floor with a spherical cap and a solid texture. Images and exact depths are rendered for any
// axial camera, by intersecting its rays with the surface. Rendering takes only milliseconds, so
// that tests of the matcher can use this scene.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <variant>

#include "axial/scene.h"
#include "base/hash.h"
#include "scene/camera_model.h"
#include "scene/depth_map.h"

namespace axial::test {

// The floor is the plane z = 2. A sphere of radius 0.5 around (0, 0, 2.2) rises from the floor. If
// bar_width is not 0, a bar parallel to y lies in front of floor and sphere.
struct TexturedScene {
  double cell = 0.02;    // size of the finest texture detail [m]
  double bar_width = 0;  // width of the bar at x = -0.15, z = 1.2 [m]

  // Distance [m] along the ray to the surface.
  double depth(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const double bar = (1.2 - origin.z()) / direction.z();
    if (std::abs(origin.x() + bar * direction.x() + 0.15) < bar_width / 2) return bar;
    return depth_without_bar(origin, direction);
  }

  double depth_without_bar(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const double floor = (2.0 - origin.z()) / direction.z();
    const Eigen::Vector3d to_centre = Eigen::Vector3d(0, 0, 2.2) - origin;
    const double along = to_centre.dot(direction);
    const double discriminant = along * along - to_centre.squaredNorm() + 0.25;
    if (discriminant < 0) return floor;
    const double sphere = along - std::sqrt(discriminant);
    return sphere > 0 && sphere < floor ? sphere : floor;
  }

  // The intensity at x: smooth noise in three octaves, about 0 to 1.
  double texture(const Eigen::Vector3d& x) const {
    return 0.45 * noise(x / cell, 1) + 0.35 * noise(x / (3 * cell), 2) +
           0.2 * noise(x / (9 * cell), 3);
  }

 private:
  static double corner(const Eigen::Vector3d& cell_corner, std::uint64_t octave) {
    std::uint64_t key = octave;
    for (int k = 0; k < 3; ++k)
      key = scramble(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell_corner[k])));
    return unit_float(key);
  }

  static double noise(const Eigen::Vector3d& x, std::uint64_t octave) {
    const Eigen::Vector3d base = x.array().floor();
    Eigen::Vector3d f = x - base;
    f = f.array() * f.array() * (3.0 - 2.0 * f.array());
    double value = 0;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d offset(i & 1, i >> 1 & 1, i >> 2);
      const Eigen::Vector3d w =
          (offset.array() * f.array() + (1 - offset.array()) * (1 - f.array())).matrix();
      value += w.prod() * corner(base + offset, octave);
    }
    return value;
  }
};

struct RenderedView {
  cv::Mat1b image;
  cv::Mat1f depth;  // lambda
};

// Renders a view. An image pixel is the mean of four rays. A depth is that of the ray through the
// pixel's centre.
inline RenderedView render(const TexturedScene& scene, const CameraModel& model, const Pose& pose) {
  RenderedView view{cv::Mat1b(model.height, model.width), cv::Mat1f(model.height, model.width)};
  std::visit(
      [&](const auto& camera) {
        const auto world_ray = [&](double u, double v) {
          auto ray = camera.ray({u, v});
          ray.origin = pose.to_world(ray.origin);
          ray.direction = pose.rotation.transpose() * ray.direction;
          return ray;
        };
        for (int y = 0; y < model.height; ++y) {
          for (int x = 0; x < model.width; ++x) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) {
              const auto ray = world_ray(x + (k & 1 ? 0.25 : -0.25), y + (k & 2 ? 0.25 : -0.25));
              sum += scene.texture(ray.at(scene.depth(ray.origin, ray.direction)));
            }
            view.image(y, x) = cv::saturate_cast<std::uint8_t>(std::round(sum / 4 * 255));
            const auto ray = world_ray(x, y);
            view.depth(y, x) = static_cast<float>(scene.depth(ray.origin, ray.direction));
          }
        }
      },
      make_camera<double>(model));
  return view;
}

}  // namespace axial::test
