// SPDX-License-Identifier: GPL-3.0-or-later
// Small surfaces with known distances.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <numbers>
#include <random>

#include "scene/mesh.h"
#include "worlds/height_field.h"

namespace axial::evaluate {

using test::append;

// Returns the surface z = height(x, y) over the square [-size/2, size/2]^2. The square is divided
// into cells x cells smaller squares with two triangles each.
inline Mesh height_field(int cells, double size,
                         const std::function<double(double, double)>& height) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(size / 2);
  return test::height_field(-half, half, static_cast<std::uint32_t>(cells), height);
}

inline Mesh flat_square(double size, double z) {
  return test::level_square({0, 0, z}, size);
}

inline double ripples(double x, double y) {
  return 0.08 * std::sin(5 * x + 1) * std::cos(4 * y) + 0.05 * std::sin(11 * y + 3 * x);
}

// Returns a sphere with faces along circles of longitude and latitude. `steps`: number of faces
// from pole to pole. With 300 steps, the distance of the faces from the exact sphere is at most
// 6e-5 times the radius.
inline Mesh sphere(double radius, int steps) {
  Mesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i < 2 * steps; ++i) {
      const double theta = std::numbers::pi * j / steps, phi = std::numbers::pi * i / steps;
      mesh.vertices.push_back(
          (radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                    std::sin(theta) * std::sin(phi), std::cos(theta)))
              .cast<float>());
    }
  const auto index = [steps](int i, int j) {
    return static_cast<std::uint32_t>(j * 2 * steps + i % (2 * steps));
  };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < 2 * steps; ++i) {
      mesh.faces.push_back({index(i, j), index(i, j + 1), index(i + 1, j)});
      mesh.faces.push_back({index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)});
    }
  return mesh;
}

inline Eigen::Vector3d random_vector(std::mt19937& random, double half_extent) {
  std::uniform_real_distribution<double> along(-half_extent, half_extent);
  const double x = along(random), y = along(random);
  return {x, y, along(random)};
}

inline Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random);
  return Eigen::Quaterniond(w, x, y, normal(random)).normalized().toRotationMatrix();
}

}  // namespace axial::evaluate
