// SPDX-License-Identifier: GPL-3.0-or-later
// Walks along a straight ray through tetrahedra.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/lists.h"
#include "mesh/tetrahedra.h"

namespace axial::mesh {

// The star of every point: the indices of the tetrahedra that have the point as a corner, finite
// and infinite, ascending. Empty if the point is no corner of any tetrahedron.
using Stars = geometry::Lists<>;

// `points`: the number of points. Precondition: every corner of `tetrahedra` is below `points` or
// is kInfinity.
Stars stars_of(const Tetrahedra& tetrahedra, std::size_t points);

// A crossing of a ray and a facet.
struct Crossing {
  std::uint32_t from, to;  // the tetrahedra before and behind the facet, in the order of the walk
  int facet;               // the number (0 to 3) of the corner of `from` opposite of the facet
  int back;                // the number (0 to 3) of the corner of `to` opposite of the facet
  double distance;         // from the start, along the ray [m]
};

// Walks from the point `start`, an index into `points`, along the unit vector `direction`. `stars`
// are the stars of `tetrahedra`. The walk ends after `length` [m], or when the ray leaves the hull.
// Calls cross(Crossing) for every facet that the ray crosses, in the order of the walk. Facets that
// have `start` as a corner are not crossed. Returns the index of the tetrahedron in which the walk
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

// A corner of a tetrahedron. `at`: its position relative to the start of a ray [m], with x and y
// across the ray and z along the ray.
struct Corner {
  std::uint32_t index = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

// The state of a walk: the ray, the current tetrahedron, and the facet through which the ray leaves
// this tetrahedron.
class RayWalker {
 public:
  // `start` is an index into `points`, and `direction` a unit vector. `tetrahedra` and `points`
  // must outlive the object.
  RayWalker(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
            std::uint32_t start, const Eigen::Vector3d& direction);

  // Finds the first tetrahedron of the walk. `star` is the star of the start. The result is the
  // tetrahedron of `star` whose cone from the start contains the direction. Returns false if the
  // direction leaves the hull at once. Then cell() is infinite, or kInfinity for an empty star.
  bool begin(std::span<const std::uint32_t> star);

  // The index of the current tetrahedron.
  std::uint32_t cell() const { return cell_; }

  // The distance [m] from the start at which the ray leaves the current tetrahedron.
  double exit_distance() const;

  // Enters the next tetrahedron, and describes the facet between the old and the new tetrahedron in
  // `crossing`. Returns false if the new tetrahedron is infinite. Precondition: begin() and all
  // earlier steps have returned true.
  bool step(Crossing& crossing);

 private:
  // Returns the infinite tetrahedron of `star` whose facet of the hull has the outward normal
  // nearest to the direction of the ray.
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
  // Rounding could make a walk go around an edge for ever. So the walk ends after this number of
  // steps without progress.
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
