// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of meshes ask of the topology (evaluate/topology.h, which has an oracle of its own).
#pragma once

#include "evaluate/topology.h"

namespace axial::test {

struct MeshFacts {
  std::size_t border_edges = 0;  // edges with one face
  std::size_t bad_edges = 0;     // of more than two faces, or of two with different orientations
  std::size_t bad_vertices = 0;  // vertices whose faces do not form one fan
  std::size_t unused_vertices = 0;
  long euler = 0;  // vertices - edges + faces
};

inline MeshFacts facts_of(const Mesh& mesh) {
  const evaluate::Topology found = evaluate::topology_of(mesh);
  return {found.border_edges, found.non_manifold_edges + found.inconsistent_edges,
          found.non_manifold_vertices, mesh.vertices.size() - found.vertices,
          static_cast<long>(found.vertices) - static_cast<long>(found.edges) +
              static_cast<long>(found.faces)};
}

}  // namespace axial::test
