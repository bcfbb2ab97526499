// SPDX-License-Identifier: GPL-3.0-or-later
// Walks along a straight ray through tetrahedra.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tetrahedra.h"

namespace axial::mesh {

// The incident tetrahedra of every point, in one array.
class Stars {
 public:
  Stars(const Tetrahedra& tetrahedra, std::size_t points);

  // The tetrahedra that have the point as a corner. Empty for a point that is no corner.
  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(cells_).subspan(begin_[point], begin_[point + 1] - begin_[point]);
  }

 private:
  std::vector<std::uint32_t> begin_, cells_;
};

struct Crossing {
  std::uint32_t from, to;  // the tetrahedra on both sides, in the order of the walk
  int facet;               // the facet is opposite of this corner of `from`,
  int back;                // and opposite of this corner of `to`
  double distance;         // along the ray [m]
};

// Walks from `start`, a corner of the tetrahedra, along the unit vector `direction`, at most
// `length` [m]. Calls cross(Crossing) for every facet that the ray crosses. Returns the tetrahedron
// in which the walk ends: one that contains the end of the ray, or an infinite one, or
// Tetrahedra::kInfinity if `start` has no tetrahedron. Crossings are computed in double; where a
// ray passes within rounding of an edge, the walk passes on one side of it.
template <class Cross>
std::uint32_t walk(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const Stars& stars, std::uint32_t start, const Eigen::Vector3d& direction,
                   double length, Cross&& cross);

namespace detail {

// A corner relative to the start of a ray: x and y across the ray, z along it.
struct Corner {
  std::uint32_t index = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

// The walk's state.
class RayWalker {
 public:
  RayWalker(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
            std::uint32_t start, const Eigen::Vector3d& direction);

  // Finds the first tetrahedron: the tetrahedron of `star` whose cone from the start contains the
  // direction. Returns false if the direction leaves the hull at once; then cell() is infinite, or
  // kInfinity for an empty star.
  bool begin(std::span<const std::uint32_t> star);

  std::uint32_t cell() const { return cell_; }

  // The distance along the ray at which it leaves the tetrahedron.
  double exit_distance() const;

  // Enters the next tetrahedron. Returns false if it is infinite.
  bool step(Crossing& crossing);

 private:
  // The infinite tetrahedron of the star whose facet of the hull faces the direction most.
  std::uint32_t facing_infinite(std::span<const std::uint32_t> star) const;
  Corner corner_at(std::uint32_t index) const;

  const Tetrahedra& tetrahedra_;
  std::span<const Eigen::Vector3f> points_;
  std::uint32_t start_, cell_ = Tetrahedra::kInfinity;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d frame_;  // rows: two directions across the ray, and the ray; right-handed
  // The facet through which the ray leaves, in counter-clockwise order seen along the ray, and the
  // position of the opposite corner in the tetrahedron.
  std::array<Corner, 3> facet_;
  int opposite_ = 0;
};

}  // namespace detail

template <class Cross>
std::uint32_t walk(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const Stars& stars, std::uint32_t start, const Eigen::Vector3d& direction,
                   double length, Cross&& cross) {
  detail::RayWalker walker(tetrahedra, points, start, direction);
  if (!walker.begin(stars.of(start))) return walker.cell();
  // By rounding, a walk could go around an edge for ever.
  constexpr int kMostSteps = 256;
  double farthest = 0;
  for (int steps = 0; steps < kMostSteps; ++steps) {
    const double distance = walker.exit_distance();
    if (!(distance < length)) break;
    if (distance > farthest) {
      farthest = distance;
      steps = 0;
    }
    Crossing crossing{};
    const bool inside = walker.step(crossing);
    cross(crossing);
    if (!inside) break;
  }
  return walker.cell();
}

}  // namespace axial::mesh
