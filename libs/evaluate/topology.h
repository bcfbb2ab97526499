// SPDX-License-Identifier: GPL-3.0-or-later
// Counts what a triangle mesh has and a surface should not have.
#pragma once

#include <cstddef>

#include "scene/mesh.h"

namespace axial::evaluate {

// Vertices are told apart by their index: two vertices at one position are two. Degenerate faces
// count only as such. All other numbers are those of the other faces.
struct Topology {
  std::size_t vertices = 0;  // that a face uses
  std::size_t faces = 0;
  std::size_t degenerate_faces = 0;  // two equal corners, or all corners on one line (exact)
  std::size_t edges = 0;
  std::size_t non_manifold_edges = 0;  // with more than two faces
  // Vertices around which the faces do not form one open or closed fan. The ends of non-manifold
  // edges are among them.
  std::size_t non_manifold_vertices = 0;
  std::size_t border_edges = 0;  // with one face
  std::size_t border_loops = 0;  // parts of the border; border edges that share a vertex are of one
  std::size_t components = 0;    // parts of the mesh; faces that share an edge are of one
  // Edges of two faces with opposite orientation: both faces pass the edge in the same direction.
  std::size_t inconsistent_edges = 0;
  std::size_t self_intersecting_faces = 0;  // self_intersections.h
};

// Error for a face index out of range or a coordinate that is not finite.
Topology topology_of(const Mesh& mesh);

}  // namespace axial::evaluate
