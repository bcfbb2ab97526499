// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest points of segments and triangles. All coordinates are in one frame.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

namespace axial::geometry {

// The point of the segment ab that is nearest to p. A segment of length 0 is a point.
inline Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return a + along * ab;
}

// The point of the closed triangle that is nearest to p. Of a triangle without area, the nearest
// point of its edges is returned.
inline Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p,
                                           const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d e1 = b - a;
  const Eigen::Vector3d e2 = c - a;
  const Eigen::Vector3d d = p - a;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double normal2 = normal.squaredNorm();
  // u, v: barycentric coordinates of the projection of p onto the plane, times normal2.
  const double u = d.cross(e2).dot(normal);
  const double v = e1.cross(d).dot(normal);
  const bool inside = normal2 > 0 && u >= 0 && v >= 0 && u + v <= normal2;
  Eigen::Vector3d best = a;
  if (inside) best = a + (u / normal2) * e1 + (v / normal2) * e2;
  // The normal of a very thin triangle is dominated by rounding, but its edges are as near as its
  // interior.
  if (inside && normal2 > 1e-16 * e1.squaredNorm() * e2.squaredNorm()) return best;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &c}, std::pair{&c, &a}}) {
    const Eigen::Vector3d candidate = closest_on_segment(p, *from, *to);
    if ((candidate - p).squaredNorm() < (best - p).squaredNorm()) best = candidate;
  }
  return best;
}

}  // namespace axial::geometry
