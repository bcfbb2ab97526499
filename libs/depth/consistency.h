// SPDX-License-Identifier: GPL-3.0-or-later
// The forward-backward error of a point and what it costs (the paper's eq. 7), for floats and for
// packs. Reference camera's frame.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::depth {

// How far from its pixel the reference camera sees the point of `ray` at distance `depth` after it
// has moved by `shift` [px], to first order in the shift across the ray: with F = do/dp + lambda
// dd/dp at the moved point's lambda, F e + mu d = shift. Against projecting the point it saves the
// projection; its relative error is about half the result in focal lengths, a fifth of a percent
// for the 3 px that count. Not finite where rays do not spread.
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

// The term of an error e [px] of forward and backward projection.
template <class T>
T inconsistency_term(const T& error, const T& limit) {
  using refractive::select;
  using std::sqrt;
  const T term = sqrt(error * (error + T(2)));
  return select(term < limit, term, limit);
}

}  // namespace axial::depth
