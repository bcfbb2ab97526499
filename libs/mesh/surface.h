// SPDX-License-Identifier: GPL-3.0-or-later
// The surface between free and occupied tetrahedra.
#pragma once

#include <span>
#include <vector>

#include "mesh/tetrahedra.h"
#include "scene/mesh.h"

namespace axial::mesh {

// A triangle mesh whose vertices are points of a cloud.
struct Surface {
  Mesh mesh;
  std::vector<std::uint32_t> points;  // per vertex of the mesh: index into `points` of surface_of()
};

// Returns the facets between free and occupied tetrahedra as triangles. `occupied` has one entry
// per tetrahedron. The vertices are elements of `points`, the points of which `tetrahedra` is made.
// Seen from the free side, the corners of a face are in counter-clockwise order. Facets with a
// corner at infinity are left out. Two faces share an edge only if all tetrahedra between them, on
// the inner side of the surface, are occupied. So where two surfaces touch at an edge or a corner,
// each surface has vertices of its own at the same place.
Surface surface_of(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const std::vector<bool>& occupied);

// Returns the surface of surface_of() without facets with long edges, because long edges cross
// places where no camera has seen a surface. `widths` has a width [m], above 0, for each point
// (MergedPoints::pixel_widths). Let the relative length of an edge be its length divided by the
// smaller width of its two points. The size of a facet is its longest relative edge. A facet is
// left out if its size is above `factor` / 3 times the median size of all facets. If `factor` is 0,
// no facet is left out.
Surface surface_without_long_edges(const Tetrahedra& tetrahedra,
                                   std::span<const Eigen::Vector3f> points,
                                   std::span<const float> widths, const std::vector<bool>& occupied,
                                   double factor);

}  // namespace axial::mesh
