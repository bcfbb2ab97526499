// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the elements of a triangle mesh, and its faults, such as edges that are not manifold.
#pragma once

#include <cstddef>

#include "scene/mesh.h"

namespace axial::evaluate {

// Vertices with different indices are different, even at the same position. Degenerate faces count
// only in `degenerate_faces`. All other numbers are computed without them.
struct Topology {
  std::size_t vertices = 0;          // vertices that a face uses
  std::size_t faces = 0;             // without the degenerate faces
  std::size_t degenerate_faces = 0;  // two equal corners, or all corners on one line (exact)
  std::size_t edges = 0;
  std::size_t non_manifold_edges = 0;  // edges of more than two faces
  // Vertices whose faces do not form exactly one open or closed fan. Both ends of every
  // non-manifold edge count.
  std::size_t non_manifold_vertices = 0;
  std::size_t border_edges = 0;  // edges of one face
  std::size_t border_loops = 0;  // connected parts of the border; border edges connect at vertices
  std::size_t components = 0;    // connected parts of the mesh; faces connect over common edges
  // Edges of two faces with different orientations: both faces list the edge in the same direction.
  std::size_t inconsistent_edges = 0;
  std::size_t self_intersecting_faces = 0;  // number of faces of self_intersecting_faces()
};

// Error if the mesh has faces and check_mesh() refuses it (scene/check_mesh.h).
Topology topology_of(const Mesh& mesh);

}  // namespace axial::evaluate
