// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/facet_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace axial::mesh {
namespace {

// The cosine of the angle between the facet's plane and the circumsphere of the tetrahedron.
double circumsphere_cosine(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                           std::size_t cell, std::size_t facet) {
  if (tetrahedra.infinite(cell)) return 1;
  std::array<Eigen::Vector3d, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = points[tetrahedra.corners[cell][i]].cast<double>();
  const Eigen::Vector3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const double twelve_volumes = 2 * a.dot(b.cross(c));
  if (twelve_volumes == 0) return 0.5;
  const Eigen::Vector3d centre =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b)) /
      twelve_volumes;
  const Eigen::Vector3d &f0 = p[(facet + 1) & 3], &f1 = p[(facet + 2) & 3],
                        &f2 = p[(facet + 3) & 3];
  const Eigen::Vector3d normal = (f1 - f0).cross(f2 - f0).normalized();
  // The plane is radius * cos(angle) away from the circumcentre.
  const double cosine = std::abs(normal.dot(p[0] + centre - f0)) / centre.norm();
  return std::isfinite(cosine) ? std::min(cosine, 1.0) : 0.5;
}

}  // namespace

double shape_cost(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                  std::size_t cell, std::size_t facet) {
  const std::uint32_t next = tetrahedra.neighbours[cell][facet];
  const auto back = static_cast<std::size_t>(
      tetrahedra.place_of_neighbour(next, static_cast<std::uint32_t>(cell)));
  return 1 - std::min(circumsphere_cosine(tetrahedra, points, cell, facet),
                      circumsphere_cosine(tetrahedra, points, next, back));
}

}  // namespace axial::mesh
