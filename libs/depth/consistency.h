// SPDX-License-Identifier: GPL-3.0-or-later
// The forward-backward error of a point and its term in the cost (the paper's eq. 7). T is float or
// a SIMD pack. Points and vectors are in the reference camera's frame.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::depth {

// The distance [px] by which the image of a point moves in the reference camera if the point moves
// by `shift` [m]. Before, the point is at distance `depth` [m] on `ray`, the ray of a pixel;
// `jacobian` has the ray's derivatives by the pixel. The result is |e| with
//
//     F e + mu d = shift,    F = do/dp + lambda dd/dp,    lambda = depth + d . shift,
//
// which is the projection to first order in the shift across the ray, but saves the time of a
// projection. The relative error is about half the result divided by the focal length: at a focal
// length of 800 px, 0.2 % for the 3 px at which the term of the cost reaches its limit. The result
// is not finite where neighbouring rays do not diverge.
template <class T>
T shift_in_pixels(const refractive::AxialRay<T>& ray,
                  const refractive::AxialRayJacobian<T>& jacobian, const T& depth,
                  const refractive::Vector3<T>& shift) {
  using std::sqrt;
  const refractive::Vector3<T>& d = ray.direction;
  const T lambda = depth + d.dot(shift);
  const refractive::Matrix32<T> spread = jacobian.origin + lambda * jacobian.direction;
  const refractive::Vector3<T> by_u = spread.col(1).cross(d);
  const refractive::Vector3<T> by_v = d.cross(spread.col(0));
  const T u = by_u.dot(shift);
  const T v = by_v.dot(shift);
  const T area = by_u.dot(spread.col(0));
  return sqrt(u * u + v * v) / area;
}

// The term sqrt(e (e + 2)) of a forward-backward error e [px], at most `limit`.
template <class T>
T inconsistency_term(const T& error, const T& limit) {
  using refractive::select;
  using std::sqrt;
  const T term = sqrt(error * (error + T(2)));
  return select(term < limit, term, limit);
}

}  // namespace axial::depth
