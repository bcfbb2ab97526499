// SPDX-License-Identifier: GPL-3.0-or-later
// The cross product of two vectors of a plane: the area of their parallelogram, positive if b lies
// counter-clockwise of a where y points upwards.
#pragma once

#include <Eigen/Core>

namespace axial {

// `a` and `b`: vectors of two components, or expressions of such vectors.
template <class A, class B>
typename A::Scalar plane_cross(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace axial
