// SPDX-License-Identifier: GPL-3.0-or-later
// Random underwater views for property tests. The views cover the range of housings for which the
// project promises accuracy. The seeds are fixed, so that a failure can be reproduced.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>

#include "drawn.h"
#include "refractive/axial_ray.h"
#include "refractive/flat_port_camera.h"

namespace axial::refractive::testing {

// Prints a measured number to standard output. The acceptance tests read the number from the
// output.
inline void report(const char* what, double value) {
  std::printf("measured: %s %.3g\n", what, value);
}

inline constexpr double kDegree = std::numbers::pi / 180;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Eigen::Vector3d unit_vector() {
    std::normal_distribution<double> normal;
    return axial::test::drawn<3>(normal, engine_).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

struct View {
  int width = 0, height = 0;
  PinholeLens<double> lens{0, 0, 0, 0};
  FlatPort<double> port;

  template <class T>
  FlatPortCamera<T> camera() const {
    return {lens.cast<T>(), port.cast<T>(), width, height};
  }
};

inline Eigen::Vector3d tilted_normal(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

// A lens with the given horizontal field of view and the principal point in the image's centre.
inline PinholeLens<double> lens_with_fov(double degrees, int width, int height) {
  const double f = 0.5 * width / std::tan(0.5 * degrees * kDegree);
  return {f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
}

// The paper's housing, with 1.4 cm of glass. `distance` [m]: the width of the air gap, by default 2
// cm.
inline FlatPort<double> paper_port(double distance = 0.02, double tilt_degrees = 0) {
  return {tilted_normal(tilt_degrees * kDegree, 0), distance, 0.014, 1, 1.52, 1.333};
}

// Returns a random view: field of view 50 to 110 degrees, tilt of the port 0 to 15 degrees in any
// direction, air gap 1 to 100 mm, glass of 0 to 20 mm with an index between silica and sapphire,
// and water with an index between fresh water and the deep sea.
inline View random_view(Random& random, int width = 1024, int height = 768) {
  View view{width, height, lens_with_fov(random.uniform(50, 110), width, height), {}};
  view.lens.cx += random.uniform(-0.02, 0.02) * width;
  view.lens.cy += random.uniform(-0.02, 0.02) * height;
  view.port.normal =
      tilted_normal(random.uniform(0, 15) * kDegree, random.uniform(0, 2 * std::numbers::pi));
  view.port.distance = random.log_uniform(0.001, 0.1);
  view.port.thickness = random.uniform(0, 0.02);
  view.port.n_air = 1.00028;
  view.port.n_glass = random.uniform(1.45, 1.78);
  view.port.n_water = random.uniform(1.325, 1.36);
  return view;
}

inline Vector2<double> random_pixel(Random& random, const View& view) {
  return {random.uniform(0, view.width - 1), random.uniform(0, view.height - 1)};
}

// The distance along `ray` of its point with the distance `range` from the camera centre.
template <class T>
T distance_from_range(const AxialRay<T>& ray, const T& range) {
  using std::sqrt;
  const T along = ray.origin.dot(ray.direction);
  const T offset2 = (ray.origin - along * ray.direction).squaredNorm();
  return sqrt(range * range - offset2) - along;
}

// Returns a point on the pixel's ray at a random distance of 0.3 to 10 m from the camera centre.
// Empty if the point is less than 1 cm behind the glass, because at a large incidence the path to
// the water can be longer than 0.3 m.
template <class T>
std::optional<Vector3<T>> random_point(Random& random, const FlatPortCamera<T>& camera,
                                       const Vector2<T>& pixel) {
  const AxialRay<T> ray = camera.ray(pixel);
  const T range = static_cast<T>(random.log_uniform(0.3, 10));
  const Vector3<T> X = ray.at(distance_from_range(ray, range));
  if (X.dot(camera.port().normal) < camera.optics().outer() + T(0.01)) return std::nullopt;
  return X;
}

}  // namespace axial::refractive::testing
