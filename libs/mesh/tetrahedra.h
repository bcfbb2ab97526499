// SPDX-License-Identifier: GPL-3.0-or-later
// The Delaunay tetrahedra of points, as plain arrays. A cell is a tetrahedron, named by its index.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace axial::mesh {

// The tetrahedra fill the convex hull of the points. In addition, an infinite tetrahedron lies
// outside of each facet of the hull. One corner of an infinite tetrahedron is at infinity.
struct Tetrahedra {
  static constexpr std::uint32_t kInfinity = 0xFFFFFFFFu;  // the corner at infinity
  using Four = std::array<std::uint32_t, 4>;

  // In a finite tetrahedron, the first three corners are counter-clockwise, seen from the last.
  std::vector<Four> corners;  // per tetrahedron: indices of points, or kInfinity
  // Per tetrahedron: [i] is the index of the tetrahedron behind the facet opposite of corner i.
  std::vector<Four> neighbours;

  std::size_t size() const { return corners.size(); }
  // True if a corner of `cell` is at infinity.
  bool infinite(std::size_t cell) const {
    for (const std::uint32_t corner : corners[cell])
      if (corner == kInfinity) return true;
    return false;
  }
  // The position (0 to 3) of `corner` among the corners of `cell`. Precondition: `cell` has this
  // corner.
  int place(std::size_t cell, std::uint32_t corner) const {
    const Four& all = corners[cell];
    return all[0] == corner ? 0 : all[1] == corner ? 1 : all[2] == corner ? 2 : 3;
  }
  // The position (0 to 3) of `neighbour` among the neighbours of `cell`. Precondition: the two
  // tetrahedra are neighbours.
  int place_of_neighbour(std::size_t cell, std::uint32_t neighbour) const {
    const Four& all = neighbours[cell];
    return all[0] == neighbour ? 0 : all[1] == neighbour ? 1 : all[2] == neighbour ? 2 : 3;
  }
};

// Returns the Delaunay tetrahedra of `points`. If several points are at the same place, only one of
// them is a corner. The result depends only on the points and their order. Precondition: the
// positions are finite. Throws an Error if all points lie in a plane, which includes fewer than
// four points.
Tetrahedra delaunay(std::span<const Eigen::Vector3f> points);

}  // namespace axial::mesh
