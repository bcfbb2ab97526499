// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of a mesh that are degenerate or intersect other faces, by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

// True if two corners of `face` have the same position, or if all three corners lie on one line.
// `face`: indices of vertices of `mesh`. Precondition: the indices are in range and the coordinates
// are finite.
bool is_degenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& face);

// Returns the indices of the faces that intersect another face, in ascending order. A vertex is
// common to two faces if both have the same vertex index. An equal position is not enough. Two
// faces intersect if they have a point in common besides their common vertex or edge:
// - Without a common vertex, they intersect if the triangles have any common point.
// - With one common vertex, they intersect if one triangle meets the edge of the other triangle
//   that is opposite to this vertex.
// - With two common vertices, they intersect if they lie in one plane, on the same side of the
//   common edge.
// - With three common vertices, they always intersect.
// These are the rules of CGAL's Polygon_mesh_processing::self_intersections. The mesh need not be
// manifold. Precondition: the indices are in range, the coordinates are finite, and no face is
// degenerate.
std::vector<std::uint32_t> self_intersecting_faces(const Mesh& mesh);

}  // namespace axial::evaluate
