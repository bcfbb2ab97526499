// SPDX-License-Identifier: GPL-3.0-or-later
// The surface between free and occupied tetrahedra.
#pragma once

#include <span>
#include <vector>

#include "mesh/tetrahedra.h"
#include "scene/mesh.h"

namespace axial::mesh {

struct Surface {
  Mesh mesh;
  std::vector<std::uint32_t> points;  // per vertex of the mesh: the index of its point
};

// The facets between free and occupied tetrahedra as triangles. Normals point to the free side.
// Facets with a corner at infinity are left out. Where surfaces touch at an edge or a corner, each
// of them gets vertices of its own at the same place: every edge joins the two faces that bound the
// same occupied tetrahedra around the edge. `occupied`: one entry per tetrahedron.
Surface surface_of(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const std::vector<bool>& occupied);

// The same without the facets whose longest edge is longer than `factor` / 3 times the median of
// the longest edges of all facets, because no camera has seen a surface there. An edge is measured
// in the smaller of the `widths` [m] of its two points, one per point. 0: leaves out no facet.
Surface surface_without_long_edges(const Tetrahedra& tetrahedra,
                                   std::span<const Eigen::Vector3f> points,
                                   std::span<const float> widths, const std::vector<bool>& occupied,
                                   double factor);

}  // namespace axial::mesh
