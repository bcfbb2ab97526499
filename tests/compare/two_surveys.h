// SPDX-License-Identifier: GPL-3.0-or-later
// Analytic surveys of a plot of hilly ground with a boulder and a coral.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>

#include "compare/registration.h"
#include "scene/mesh.h"
#include "worlds/height_field.h"

namespace axial::test {

using Height = std::function<double(double x, double y)>;

// Hills of 9 cm and 5 cm over lengths of 0.6 to 1.1 m.
inline double hills(double x, double y) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return 0.09 * std::sin(kTurn * x / 1.1 + 0.3) * std::cos(kTurn * y / 0.9) +
         0.05 * std::sin(kTurn * (x + 0.7 * y) / 0.6);
}

// A half ellipsoid on the ground.
struct Boulder {
  double x, y;
  double a = 0.3, b = 0.22, c = 0.15;  // semi-axes along x, y and z [m]

  double volume() const { return 2.0 / 3 * std::numbers::pi * a * b * c; }
  double operator()(double at_x, double at_y) const {
    const double u = (at_x - x) / a, v = (at_y - y) / b;
    return c * std::sqrt(std::max(0.0, 1 - u * u - v * v));
  }
};

// A rough patch of 1 m x 0.3 m on the ground, whose height is `mean` on average.
struct Coral {
  double x, y, mean;

  static constexpr double kArea = 0.3;
  double operator()(double at_x, double at_y) const {
    if (std::abs(at_x - x) > 0.5 || std::abs(at_y - y) > 0.15) return 0;
    constexpr double kTurn = 2 * std::numbers::pi;
    return mean + 0.008 * std::sin(kTurn * at_x / 0.09) * std::sin(kTurn * at_y / 0.07);
  }
};

struct Plot {
  Eigen::Vector2d low{0, 0}, high{4, 3};
  double spacing = 0.0125;  // of the vertices [m]
  double noise = 0.002;     // standard deviation of each coordinate of the vertices [m]
  std::uint64_t seed = 1;
};

// The mesh of the surface `height` over the plot.
inline Mesh surveyed(const Plot& plot, const Height& height) {
  std::mt19937_64 random(plot.seed);
  std::normal_distribution<double> noise(0, 1);
  const auto columns = static_cast<std::uint32_t>((plot.high.x() - plot.low.x()) / plot.spacing);
  const auto rows = static_cast<std::uint32_t>((plot.high.y() - plot.low.y()) / plot.spacing);
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = plot.low.x() + i * plot.spacing, y = plot.low.y() + j * plot.spacing;
      Eigen::Vector3d vertex(x, y, height(x, y));
      for (double& coordinate : vertex) coordinate += plot.noise * noise(random);
      mesh.vertices.push_back(vertex.cast<float>());
    }
  mesh.faces = grid_faces(columns, rows);
  return mesh;
}

inline const Boulder kBoulderBefore{1.0, 0.8}, kBoulderAfter{2.9, 2.1};
inline constexpr double kGrowth = 0.02;  // of the coral [m]

inline double ground_before(double x, double y) {
  return hills(x, y) + kBoulderBefore(x, y) + Coral{2.7, 0.6, 0.03}(x, y);
}
inline double ground_after(double x, double y) {
  return hills(x, y) + kBoulderAfter(x, y) + Coral{2.7, 0.6, 0.03 + kGrowth}(x, y);
}

// The two surveys. Their vertices are at different places.
inline Mesh survey_before(std::uint64_t seed = 1) {
  return surveyed({.seed = seed}, ground_before);
}
inline Mesh survey_after(std::uint64_t seed = 2) {
  return surveyed({.low = {0.006, 0.004}, .high = {4.03, 2.99}, .seed = seed}, ground_after);
}

// The mesh that `motion` moves to `mesh`.
inline Mesh moved_back(Mesh mesh, const compare::RigidMotion& motion) {
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (motion.rotation.transpose() *
                  (vertex.cast<double>() - motion.centre - motion.translation) +
              motion.centre)
                 .cast<float>();
  return mesh;
}

// A motion of some centimetres and of half a degree about `centre`.
inline compare::RigidMotion small_motion(const Eigen::Vector3d& centre = {0, 0, 0}) {
  const Eigen::Vector3d turn(0.004, -0.003, 0.007);
  return {Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
          {0.012, -0.018, 0.025},
          centre};
}

// The rotation vector and the translation that are left of `truth` after `found` (about the centre
// of `found`).
inline compare::Vector6d error_of_motion(const compare::RigidMotion& found,
                                         const compare::RigidMotion& truth) {
  const Eigen::Matrix3d left = found.rotation * truth.rotation.transpose();
  const Eigen::AngleAxisd turn(left);
  const Eigen::Vector3d centre = found.centre;
  const Eigen::Vector3d there =
      truth.rotation * (centre - truth.centre) + truth.centre + truth.translation;
  compare::Vector6d error;
  error << turn.angle() * turn.axis(), centre + found.translation - there;
  return error;
}

}  // namespace axial::test
