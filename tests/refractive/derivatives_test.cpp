// SPDX-License-Identifier: GPL-3.0-or-later
// Compares closed-form derivatives with ceres::Jet and with finite differences. The tolerance is
// 1e-6 of the Jacobian's Frobenius norm.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "refractive/differences.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

using Jet2 = ceres::Jet<double, 2>;
template <class Jet>
FlatPortCamera<Jet> jet_camera(const View& view) {
  return view.camera<Jet>();
}

TEST(Derivatives, OfTheProjection) {
  Random random(61);
  for (int k = 0; k < 2000; ++k) {
    const View view = random_view(random);
    const auto X = random_point(random, view.camera<double>(), random_pixel(random, view));
    if (X) check_projection(view, *X);
  }
}

TEST(Derivatives, OfTheProjectionOnAndNearTheAxis) {
  Random random(62);
  for (int k = 0; k < 200; ++k) {
    const View view = random_view(random);
    const Vector3<double>& n = view.port.normal;
    const Vector3<double> e = random.unit_vector().cross(n).normalized();
    for (const double rho : {0.0, 1e-18, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3})
      check_projection(view, random.log_uniform(0.3, 10) * n + rho * e);
  }
}

void check_ray(const View& view, const Vector2<double>& pixel) {
  const auto camera = view.camera<double>();
  AxialRayJacobian<double> jacobian;
  const AxialRay<double> ray = camera.ray(pixel, jacobian);
  const AxialRay<double> plain = camera.ray(pixel);
  EXPECT_LT((ray.origin - plain.origin).norm() + (ray.direction - plain.direction).norm(), 1e-15);

  const auto jets = jet_camera<Jet2>(view).ray(variables<Jet2, 2>(pixel));
  // The derivative of the origin vanishes on the axis, so that its error cannot be relative to
  // itself. It is relative to the motion [m/px] of a point of the ray at 1 m, which is the norm of
  // the direction's derivative.
  const double scale = jacobian.direction.norm();
  expect_close(jacobian.direction, derivatives<Jet2, 3>(jets.direction), scale);
  expect_close(jacobian.origin, derivatives<Jet2, 3>(jets.origin),
               std::max(jacobian.origin.norm(), 1e-6 * scale));
  const double h = 1e-3;  // [px]; errors of rounding and of curvature are below 1e-9 of the result
  expect_close(jacobian.direction,
               differences<3, 2>(pixel, h,
                                 [&](const Vector2<double>& p) { return camera.ray(p).direction; }),
               scale);
  expect_close(
      jacobian.origin,
      differences<3, 2>(pixel, h, [&](const Vector2<double>& p) { return camera.ray(p).origin; }),
      std::max(jacobian.origin.norm(), 1e-3 * scale));
}

TEST(Derivatives, OfTheRay) {
  Random random(63);
  for (int k = 0; k < 2000; ++k) {
    const View view = random_view(random);
    check_ray(view, random_pixel(random, view));
  }
}

TEST(Derivatives, OfTheRayOnAndNearTheAxis) {
  Random random(64);
  for (int k = 0; k < 200; ++k) {
    const View view = random_view(random);
    const Vector2<double> foot = view.lens.pixel(view.port.normal);
    for (const double away : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0})
      check_ray(view, foot + Vector2<double>(away, -0.7 * away));
  }
}

// Bundle adjustment needs derivatives by the parameters of the port. The iterations of the solver
// must not lose them.
TEST(Derivatives, ByThePortsParameters) {
  Random random(65);
  using Jet4 = ceres::Jet<double, 4>;
  for (int k = 0; k < 300; ++k) {
    const View view = random_view(random);
    const auto X = random_point(random, view.camera<double>(), random_pixel(random, view));
    if (!X) continue;
    const auto project = [&]<class T>(const Eigen::Matrix<T, 4, 1>& p) {
      FlatPort<T> port = view.port.cast<T>();
      port.distance = p(0);
      port.thickness = p(1);
      port.n_glass = p(2);
      port.n_water = p(3);
      const FlatPortCamera<T> camera(view.lens.cast<T>(), port, view.width, view.height);
      return camera.project(X->cast<T>()).pixel;
    };
    const Eigen::Vector4d p(view.port.distance, view.port.thickness, view.port.n_glass,
                            view.port.n_water);
    const Eigen::Matrix<double, 2, 4> jacobian =
        derivatives<Jet4, 2>(project(variables<Jet4, 4>(p)));
    const auto numeric =
        differences<2, 4>(p, 1e-6, [&](const Eigen::Vector4d& q) { return project(q); });
    expect_close(jacobian, numeric, jacobian.norm());
  }
}

}  // namespace
}  // namespace axial::refractive::testing
