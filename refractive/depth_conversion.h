// SPDX-License-Identifier: GPL-3.0-or-later
// The three meanings of depth, for the ray of any axial camera:
//
//     distance  lambda of X = origin + lambda * direction (the paper's eq. 4): in memory
//     range     |X|, from the camera centre (the paper's eq. 5)
//     z-depth   X.z in the camera frame: in files
//
// All in metres, all in the camera frame. For a pinhole distance and range are the same. NaN in,
// NaN out.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

template <class T>
T range_from_distance(const AxialRay<T>& ray, const T& distance) {
  using std::sqrt;
  return sqrt(ray.at(distance).squaredNorm());
}

// The point in front of the origin at that range. A range smaller than the closest the ray comes to
// the camera centre gives that closest point.
template <class T>
T distance_from_range(const AxialRay<T>& ray, const T& range) {
  using std::sqrt;
  const T along = ray.origin.dot(ray.direction);
  // range^2 - (distance of the centre from the line)^2, without cancelling two squares.
  const T offset2 = (ray.origin - along * ray.direction).squaredNorm();
  const T chord2 = range * range - offset2;
  return (chord2 <= T(0) ? T(0) : T(sqrt(chord2))) - along;
}

template <class T>
T z_depth_from_distance(const AxialRay<T>& ray, const T& distance) {
  return ray.origin.z() + distance * ray.direction.z();
}

// A ray at right angles to the optical axis gives infinity or NaN.
template <class T>
T distance_from_z_depth(const AxialRay<T>& ray, const T& z_depth) {
  return (z_depth - ray.origin.z()) / ray.direction.z();
}

}  // namespace axial::refractive
