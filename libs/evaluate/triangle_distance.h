// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace axial::evaluate {

// The point of the segment ab nearest to p. A segment of no length is its point.
inline Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return a + along * ab;
}

// The point of the closed triangle nearest to p. Triangles of no area count as their edges.
inline Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p,
                                           const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d& a = corners[0];
  const Eigen::Vector3d e1 = corners[1] - a;
  const Eigen::Vector3d e2 = corners[2] - a;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double normal2 = normal.squaredNorm();
  if (normal2 > 0) {  // barycentric coordinates of p's foot on the plane, times normal2
    const Eigen::Vector3d d = p - a;
    const double w1 = d.cross(e2).dot(normal);
    const double w2 = e1.cross(d).dot(normal);
    if (w1 >= 0 && w2 >= 0 && w1 + w2 <= normal2) return p - normal * (normal.dot(d) / normal2);
  }
  Eigen::Vector3d best = closest_on_segment(p, a, corners[1]);
  for (int edge = 1; edge < 3; ++edge) {
    const Eigen::Vector3d candidate =
        closest_on_segment(p, corners[static_cast<std::size_t>(edge)],
                           corners[static_cast<std::size_t>((edge + 1) % 3)]);
    if ((candidate - p).squaredNorm() < (best - p).squaredNorm()) best = candidate;
  }
  return best;
}

}  // namespace axial::evaluate
