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

// For every point, the tetrahedra that have the point as a corner. All are in one array.
class Stars {
 public:
  Stars(const Tetrahedra& tetrahedra, std::size_t points);

  // The tetrahedra that have the point as a corner. Empty if the point is no corner of any
  // tetrahedron.
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

// Walks from the point `start` along the unit vector `direction`. `start` is a corner of the
// tetrahedra. The walk ends after `length` [m], or when the ray leaves the hull. Calls
// cross(Crossing) for every facet that the ray crosses. Returns the tetrahedron in which the walk
// ends:
//
//   - Tetrahedra::kInfinity if `start` is no corner of any tetrahedron,
//   - an infinite tetrahedron if the ray leaves the hull,
//   - otherwise the tetrahedron that contains the end of the ray.
//
// Crossings are computed in double. Where the distance from a ray to an edge is within rounding,
// the walk passes on either side of the edge.
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

  // Finds the first tetrahedron of the walk: the tetrahedron of `star` whose cone from the start
  // contains the direction. Returns false if the direction leaves the hull at once. Then cell() is
  // infinite, or kInfinity for an empty star.
  bool begin(std::span<const std::uint32_t> star);

  std::uint32_t cell() const { return cell_; }

  // The distance from the start at which the ray leaves the tetrahedron.
  double exit_distance() const;

  // Enters the next tetrahedron. Returns false if it is infinite.
  bool step(Crossing& crossing);

 private:
  // An infinite tetrahedron of `star`: the facet of the hull beside it faces the direction most.
  std::uint32_t facing_infinite(std::span<const std::uint32_t> star) const;
  Corner corner_at(std::uint32_t index) const;

  const Tetrahedra& tetrahedra_;
  std::span<const Eigen::Vector3f> points_;
  std::uint32_t start_, cell_ = Tetrahedra::kInfinity;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d frame_;  // rows: two directions across the ray, and the ray; right-handed
  // The facet through which the ray leaves the tetrahedron. Its corners are in counter-clockwise
  // order, seen along the ray.
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
