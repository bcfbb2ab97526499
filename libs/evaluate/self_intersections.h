// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of a mesh that are degenerate or intersect other faces, by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

// True if two corners of the face are equal or all three lie on one line. Precondition: the indices
// are in range and the coordinates finite.
bool is_degenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& face);

// Returns the indices of the faces that intersect another face, in ascending order. Two faces
// intersect if they have a point in common besides the vertex or the edge that they share:
// - without a common vertex: if the triangles meet at all;
// - with one common vertex: if the edge opposite to it, of one of them, meets the other;
// - with a common edge: if they lie in one plane on the same side of the edge;
// - with three common vertices: always.
// Vertices are common if their index is the same. These are the rules of CGAL's
// Polygon_mesh_processing::self_intersections, for meshes that need not be manifold. Precondition:
// as above, and no face is degenerate.
std::vector<std::uint32_t> self_intersecting_faces(const Mesh& mesh);

}  // namespace axial::evaluate
