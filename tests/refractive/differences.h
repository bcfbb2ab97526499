// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic and numeric derivatives, for comparison with closed forms.
#pragma once

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "refractive/axial_ray.h"

namespace axial::refractive::testing {

inline constexpr double kRelative = 1e-6;

template <class Jet, int N>
Eigen::Matrix<Jet, N, 1> variables(const Eigen::Matrix<double, N, 1>& x) {
  Eigen::Matrix<Jet, N, 1> jets;
  for (int k = 0; k < N; ++k) jets(k) = Jet(x(k), k);
  return jets;
}

template <class Jet, int N>
auto derivatives(const Eigen::Matrix<Jet, N, 1>& jets) {
  Eigen::Matrix<double, N, Jet::DIMENSION> jacobian;
  for (int k = 0; k < N; ++k) jacobian.row(k) = jets(k).v.transpose();
  return jacobian;
}

// Central differences of a function of a vector.
template <int M, int N, class Function>
Eigen::Matrix<double, M, N> differences(const Eigen::Matrix<double, N, 1>& x, double h,
                                        Function f) {
  Eigen::Matrix<double, M, N> jacobian;
  for (int k = 0; k < N; ++k) {
    const Eigen::Matrix<double, N, 1> step = Eigen::Matrix<double, N, 1>::Unit(k) * h;
    jacobian.col(k) = (f(x + step) - f(x - step)) / (2 * h);
  }
  return jacobian;
}

template <class A, class B>
void expect_close(const A& a, const B& b, double scale) {
  EXPECT_LE((a - b).norm(), kRelative * scale) << a << "\n\n" << b;
}

// Compares the Jacobian of a view's projection at X with automatic and numeric derivatives.
template <class View>
void check_projection(const View& view, const Vector3<double>& X) {
  using Jet = ceres::Jet<double, 3>;
  const auto camera = view.template camera<double>();
  Matrix23<double> jacobian;
  ASSERT_TRUE(camera.project(X, &jacobian).visible);
  const auto jets = view.template camera<Jet>().project(variables<Jet, 3>(X));
  expect_close(jacobian, derivatives<Jet, 2>(jets.pixel), jacobian.norm());
  // Pixels have an error of 1e-12, and the curvature of the projection shows over centimetres. With
  // this step both contribute errors near 1e-8.
  const auto numeric =
      differences<2, 3>(X, 1e-6, [&](const Vector3<double>& x) { return camera.project(x).pixel; });
  expect_close(jacobian, numeric, jacobian.norm());
}

}  // namespace axial::refractive::testing
