// SPDX-License-Identifier: GPL-3.0-or-later
// Conversions between the three meanings of depth, for a ray X = origin + lambda * direction of
// any axial camera:
//
//     distance  lambda, the distance from the ray's origin (the paper's eq. 4); used in memory
//     range     |X|, the distance from the camera centre (the paper's eq. 5)
//     z-depth   the z of X in the camera frame; used in files
//
// All three are in metres. Rays are in the camera frame. For a pinhole, distance and range are
// equal. If an argument is NaN, the result is NaN. docs/refraction.md names the paper.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

template <class T>
T range_from_distance(const AxialRay<T>& ray, const T& distance) {
  using std::sqrt;
  return sqrt(ray.at(distance).squaredNorm());
}

// The distance [m] of the point with the given range [m] on the line of `ray`. If two points have
// this range, the result is the larger distance. If every point of the line has a larger range,
// the result is the distance of the point nearest to the camera centre. Precondition: range >= 0.
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

// The distance [m] of the point with the given z-depth [m] on the line of `ray`. A ray
// perpendicular to the optical axis gives infinity or NaN.
template <class T>
T distance_from_z_depth(const AxialRay<T>& ray, const T& z_depth) {
  return (z_depth - ray.origin.z()) / ray.direction.z();
}

}  // namespace axial::refractive
