// SPDX-License-Identifier: GPL-3.0-or-later
// The point nearest to several rays.
#pragma once

#include <span>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// normal * point = right for the point with the least sum of squared distances to the lines of
// rays. `normal` is singular for parallel rays and for none.
template <class T>
struct NearestPointEquations {
  Matrix3<T> normal = Matrix3<T>::Zero();
  Vector3<T> right = Vector3<T>::Zero();
};

template <class T>
NearestPointEquations<T> nearest_point_equations(std::span<const AxialRay<T>> rays) {
  NearestPointEquations<T> equations;
  for (const AxialRay<T>& ray : rays) {
    const Matrix3<T> across = Matrix3<T>::Identity() - ray.direction * ray.direction.transpose();
    equations.normal += across;
    equations.right += across * ray.origin;
  }
  return equations;
}

}  // namespace axial::refractive
