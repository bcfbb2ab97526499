// SPDX-License-Identifier: BSD-3-Clause
// The point nearest to several rays, in the least-squares sense.
#pragma once

#include <span>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// The normal equations of the point nearest to several rays: normal * point = right. The solution
// [m, frame of the rays] is the point with the smallest sum of squared distances to the lines of
// the rays. `normal` is singular if all rays are parallel or if there are no rays.
template <class T>
struct NearestPointEquations {
  Matrix3<T> normal = Matrix3<T>::Zero();
  Vector3<T> right = Vector3<T>::Zero();
};

// Sets up the equations for `rays`, all in one frame. Precondition: directions of unit length.
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
