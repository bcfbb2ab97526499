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

// Returns the facets between free and occupied tetrahedra as triangles. Normals point to the free
// side. Facets with a corner at infinity are left out. Two faces share an edge only if all
// tetrahedra between them, on the inner side of the surface, are occupied. So where two surfaces
// touch at an edge or a corner, each surface has vertices of its own at the same place. `occupied`:
// one entry per tetrahedron.
Surface surface_of(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const std::vector<bool>& occupied);

// The same, but without facets with long edges, because long edges cross places where no camera has
// seen a surface. `widths`: a width [m] for each point. Let the relative length of an edge be its
// length divided by the smaller width of its two points. The size of a facet is its longest
// relative edge. A facet is left out if its size is above `factor` / 3 times the median size of all
// facets. With `factor` 0 no facet is left out.
Surface surface_without_long_edges(const Tetrahedra& tetrahedra,
                                   std::span<const Eigen::Vector3f> points,
                                   std::span<const float> widths, const std::vector<bool>& occupied,
                                   double factor);

}  // namespace axial::mesh
