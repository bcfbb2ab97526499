// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of faces that are seen from above: exactly, but for 1e-7 m at the edges and 1e-7 m of
// height.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "map/surface_block.h"
#include "scene/mesh.h"

namespace axial::map {

// At each place, the highest face is seen, from either side. Of faces at the same height up to
// 1e-7 m, the one with the lowest index is seen. A vertical face hides nothing, and is hidden by
// what lies above it. Lengths are those of the mesh [m], z points upwards.
class SeenFaces {
 public:
  // `mesh` must outlive the object. Precondition: the vertices of the faces exist.
  explicit SeenFaces(const Mesh& mesh);

  // The memory [bytes] of the object.
  static std::uint64_t bytes(const Mesh& mesh);

  // The faces that may be above or below a box, in increasing order.
  std::vector<std::uint32_t> faces_in(const Eigen::AlignedBox2d& box) const;

  // A place is on the positive side if normal.dot(place - base) >= shift.
  struct HalfSpace {
    Eigen::Vector3d normal, base;
    double shift = 0;

    double operator()(const Eigen::Vector3d& x) const { return normal.dot(x - base) - shift; }
  };
  // What a face hides: the places inside of its edges by more than 1e-9 m, and below it. The bases
  // of the first three half spaces are its corners.
  using Hidden = std::array<HalfSpace, 4>;

  // What other faces hide of `face` over `box`. Empty: all of it is seen.
  void find_hidden(std::uint32_t face, const Eigen::AlignedBox2d& box,
                   std::vector<Hidden>& hidden) const;

 private:
  template <class Takes>
  std::vector<std::uint32_t> faces_in_bins(const Eigen::AlignedBox2d& box,
                                           const Takes& takes) const;

  const Mesh& mesh_;
  MapGrid grid_;
  FaceBins bins_;
};

// Whether a convex polygon in a plane is narrower than 1e-7 m. `along`: the factors of its
// coordinates; (1, 1, 0) for its picture on the map, where a vertical polygon is narrow.
bool is_narrow(std::span<const Eigen::Vector3d> piece,
               const Eigen::Vector3d& along = Eigen::Vector3d::Ones());

// Calls `use` for the parts of a convex polygon in a plane that are not `hidden`, which are convex
// and keep its direction. Narrow parts are left out.
void for_seen_parts(std::span<const Eigen::Vector3d> piece,
                    std::span<const SeenFaces::Hidden> hidden,
                    const std::function<void(std::span<const Eigen::Vector3d>)>& use);

}  // namespace axial::map
