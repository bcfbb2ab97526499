// SPDX-License-Identifier: GPL-3.0-or-later
// The three meanings of depth, for the ray of any axial camera:
//
//     distance  lambda of X = origin + lambda * direction (the paper's eq. 4): in memory
//     range     |X|, from the camera centre (the paper's eq. 5)
//     z-depth   X.z in the camera frame: in files
//
// All are in metres and in the camera frame. For a pinhole, distance and range are equal. If an
// argument is NaN, the result is NaN.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

template <class T>
T range_from_distance(const AxialRay<T>& ray, const T& distance) {
  using std::sqrt;
  return sqrt(ray.at(distance).squaredNorm());
}

// The distance of the ray's farther point at this range. If the range is smaller than the smallest
// range on the ray's line, the result belongs to the point with the smallest range.
template <class T>
T distance_from_range(const AxialRay<T>& ray, const T& range) {
  using std::sqrt;
  const T along = ray.origin.dot(ray.direction);
  // The distance of the camera centre from the ray's line, squared. It is computed without a
  // difference of two large squares, which would cancel.
  const T offset2 = (ray.origin - along * ray.direction).squaredNorm();
  const T chord2 = range * range - offset2;
  return (chord2 <= T(0) ? T(0) : T(sqrt(chord2))) - along;
}

template <class T>
T z_depth_from_distance(const AxialRay<T>& ray, const T& distance) {
  return ray.origin.z() + distance * ray.direction.z();
}

// A ray perpendicular to the optical axis gives infinity or NaN.
template <class T>
T distance_from_z_depth(const AxialRay<T>& ray, const T& z_depth) {
  return (z_depth - ray.origin.z()) / ray.direction.z();
}

}  // namespace axial::refractive
