// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/ray_walk.h"

#include <algorithm>
#include <limits>

namespace axial::mesh {

Stars stars_of(const Tetrahedra& tetrahedra, std::size_t points) {
  return geometry::lists_of(points, [&](const auto& add) {
    for (std::uint32_t cell = 0; cell < tetrahedra.size(); ++cell)
      for (const std::uint32_t corner : tetrahedra.corners[cell])
        if (corner != Tetrahedra::kInfinity) add(corner, cell);
  });
}

namespace detail {
namespace {

// Rows: two directions across the unit vector `direction`, and the direction; right-handed.
Eigen::Matrix3d ray_frame(const Eigen::Vector3d& direction) {
  Eigen::Matrix3d frame;
  const Eigen::Vector3d across = direction.unitOrthogonal();
  frame << across.transpose(), direction.cross(across).transpose(), direction.transpose();
  return frame;
}

// Twice the area of the triangle of the ray, a and b; positive if b is counter-clockwise of a, seen
// along the ray.
double area(const Corner& a, const Corner& b) {
  return a.at.x() * b.at.y() - a.at.y() * b.at.x();
}

}  // namespace

RayWalker::RayWalker(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                     std::uint32_t start, const Eigen::Vector3d& direction)
    : tetrahedra_(tetrahedra),
      points_(points),
      start_(start),
      origin_(points[start].cast<double>()),
      frame_(ray_frame(direction)) {}

Corner RayWalker::corner_at(std::uint32_t index) const {
  return {index, frame_ * (points_[index].cast<double>() - origin_)};
}

bool RayWalker::begin(std::span<const std::uint32_t> star) {
  double best = -std::numeric_limits<double>::infinity(), size = 0;
  for (const std::uint32_t candidate : star) {
    if (tetrahedra_.infinite(candidate)) continue;
    const int place = tetrahedra_.place(candidate, start_);
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] =
          corner_at(tetrahedra_.corners[candidate][(static_cast<std::size_t>(place) + 1 + k) & 3]);
    if (corners[0].at.dot(corners[1].at.cross(corners[2].at)) < 0)
      std::swap(corners[1], corners[2]);
    const double inside = std::min(
        {area(corners[0], corners[1]), area(corners[1], corners[2]), area(corners[2], corners[0])});
    if (inside > best) {
      best = inside;
      size = std::max(
          {corners[0].at.squaredNorm(), corners[1].at.squaredNorm(), corners[2].at.squaredNorm()});
      cell_ = candidate;
      facet_ = corners;
      opposite_ = place;
    }
    if (inside > 0) return true;
  }
  // By rounding, a ray along an edge may be outside of all cones.
  if (cell_ != Tetrahedra::kInfinity && best >= -1e-12 * size) return true;
  cell_ = facing_infinite(star);
  return false;
}

std::uint32_t RayWalker::facing_infinite(std::span<const std::uint32_t> star) const {
  std::uint32_t best = Tetrahedra::kInfinity;
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t cell : star) {
    const Tetrahedra::Four& corners = tetrahedra_.corners[cell];
    const auto at = std::ranges::find(corners, Tetrahedra::kInfinity);
    if (at == corners.end()) continue;
    const auto i = static_cast<std::size_t>(at - corners.begin());
    const std::uint32_t inner = tetrahedra_.neighbours[cell][i];
    const auto back = static_cast<std::size_t>(tetrahedra_.place_of_neighbour(inner, cell));
    const Eigen::Vector3d a = corner_at(corners[(i + 1) & 3]).at,
                          b = corner_at(corners[(i + 2) & 3]).at,
                          c = corner_at(corners[(i + 3) & 3]).at,
                          inside = corner_at(tetrahedra_.corners[inner][back]).at;
    Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    if (normal.dot(inside - a) > 0) normal = -normal;
    if (normal.z() > largest) {
      largest = normal.z();
      best = cell;
    }
  }
  return best;
}

double RayWalker::exit_distance() const {
  const double w0 = area(facet_[1], facet_[2]), w1 = area(facet_[2], facet_[0]),
               w2 = area(facet_[0], facet_[1]);
  return (w0 * facet_[0].at.z() + w1 * facet_[1].at.z() + w2 * facet_[2].at.z()) / (w0 + w1 + w2);
}

bool RayWalker::step(Crossing& crossing) {
  const std::uint32_t next = tetrahedra_.neighbours[cell_][static_cast<std::size_t>(opposite_)];
  const int entry = tetrahedra_.place_of_neighbour(next, cell_);
  crossing = {cell_, next, opposite_, entry, std::max(0.0, exit_distance())};
  cell_ = next;
  const std::uint32_t index = tetrahedra_.corners[next][static_cast<std::size_t>(entry)];
  if (index == Tetrahedra::kInfinity || tetrahedra_.infinite(next)) return false;
  const Corner corner = corner_at(index);
  // The ray leaves through the facet of the new corner and the edge (i, i + 1) of the old facet if
  // it passes between both: area(i, corner) <= 0 <= area(i + 1, corner).
  const double a0 = area(facet_[0], corner), a1 = area(facet_[1], corner),
               a2 = area(facet_[2], corner);
  const double b0 = std::min(-a0, a1), b1 = std::min(-a1, a2), b2 = std::min(-a2, a0);
  const std::size_t replaced = b0 >= b1 && b0 >= b2 ? 2 : b1 >= b2 ? 0 : 1;
  opposite_ = tetrahedra_.place(cell_, facet_[replaced].index);
  facet_[replaced] = corner;
  return true;
}

}  // namespace detail
}  // namespace axial::mesh
