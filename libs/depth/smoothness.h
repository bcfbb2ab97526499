// SPDX-License-Identifier: GPL-3.0-or-later
// The smoothness factor of a hypothesis (the paper's eq. 6). In eq. 6, d_v is the distance
// n . (X_n - X), where n is the normal and X the point of the hypothesis, and X_n is the point of a
// neighbour. T is float or a SIMD pack.
#pragma once

#include <array>
#include <span>

#include "axial/depth.h"
#include "refractive/axial_ray.h"

namespace axial::depth {

// The surface at a neighbouring pixel: a point [m] and a unit normal in the reference camera's
// frame.
struct SurfacePoint {
  std::array<float, 3> point, normal;
};

// Approximates exp(-x) for x >= 0 by (1 - x/16)^16, and by 0 for x > 16. The error is at most
// 0.017.
template <class T>
T fading(const T& x) {
  using refractive::select;
  T y = T(1) - x * T(0.0625f);
  y = select(y > T(0), y, T(0));
  y *= y;
  y *= y;
  y *= y;
  return y * y;
}

// Returns the factor of the cost of the plane through `point` [m] with the unit normal `normal`,
// both in the reference camera's frame. The factor is the product, over the neighbours, of
// (1 - depth_bonus exp(-d_v^2 / (2 |X|^2 depth_sigma^2))) and
// (1 - normal_bonus exp(-angle^2 / (2 normal_sigma^2))), with fading() for exp(-x). So it is at
// most 1, and 1 without neighbours.
template <class T>
T smoothness(const refractive::Vector3<T>& point, const refractive::Vector3<T>& normal,
             std::span<const SurfacePoint> neighbours, const SmoothnessOptions& options) {
  using refractive::select;
  const T depth_scale(0.5f / (options.depth_sigma * options.depth_sigma));
  const T angle_scale(0.5f / (options.normal_sigma * options.normal_sigma));
  const T distance_scale = depth_scale / point.squaredNorm();
  T factor(1);
  for (const SurfacePoint& other : neighbours) {
    const auto& p = other.point;
    const auto& n = other.normal;
    const T distance = normal.x() * (T(p[0]) - point.x()) + normal.y() * (T(p[1]) - point.y()) +
                       normal.z() * (T(p[2]) - point.z());
    const T cosine = normal.x() * T(n[0]) + normal.y() * T(n[1]) + normal.z() * T(n[2]);
    const T versine = T(1) - select(cosine < T(1), cosine, T(1));
    const T angle2 = versine * (T(2) + versine * T(1.0f / 3.0f));  // angle^2, error of 6th order
    factor *= T(1) - T(options.depth_bonus) * fading<T>(distance_scale * distance * distance);
    factor *= T(1) - T(options.normal_bonus) * fading<T>(angle_scale * angle2);
  }
  return factor;
}

}  // namespace axial::depth
