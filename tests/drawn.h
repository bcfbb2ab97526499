// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of random numbers. C++ leaves the order of arguments open: the values of
// Eigen::Vector2d(normal(random), normal(random)) would depend on the compiler.
#pragma once

#include <Eigen/Core>

namespace axial::test {

// Draws the last coordinate first, as GCC evaluates arguments: the limits of the statistical tests
// were chosen on these numbers.
template <int kRows, class Distribution, class Engine>
Eigen::Matrix<typename Distribution::result_type, kRows, 1> drawn(Distribution& distribution,
                                                                  Engine& engine) {
  Eigen::Matrix<typename Distribution::result_type, kRows, 1> vector;
  for (int k = kRows - 1; k >= 0; --k) vector[k] = distribution(engine);
  return vector;
}

}  // namespace axial::test
