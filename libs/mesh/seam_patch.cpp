// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/seam_patch.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <set>

#include "private/halfedge_mesh.h"

namespace axial::mesh {
namespace pmp = CGAL::Polygon_mesh_processing;
namespace {

using Place = HalfedgeKernel::Point_3;
using Faces = std::vector<HalfedgeMesh::Face_index>;

void remove_faces(HalfedgeMesh& mesh, const Faces& faces) {
  for (const auto face : faces)
    if (!mesh.is_removed(face)) CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
  pmp::duplicate_non_manifold_vertices(mesh);
}

// Closes gaps. Returns the faces at the gaps that could not be closed, because the new faces would
// have had an edge that the mesh has already.
Faces faces_at_open_gaps(HalfedgeMesh& mesh, std::size_t most, const VertexFilter& is_fixed) {
  close_holes(mesh, most, is_fixed);
  std::vector<HalfedgeMesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  Faces faces;
  for (const auto cycle : cycles) {
    Faces around;
    bool is_gap = true;
    for (const auto half : mesh.halfedges_around_face(cycle)) {
      around.push_back(mesh.face(mesh.opposite(half)));
      is_gap = is_gap && !is_fixed(mesh.target(half));
    }
    if (is_gap && around.size() <= most) faces.insert(faces.end(), around.begin(), around.end());
  }
  return faces;
}

}  // namespace

Mesh mend_patch(const Mesh& patch, const std::vector<bool>& fixed, std::size_t close_gaps) {
  constexpr int kRounds = 6;
  // By positions, because the conversion may number vertices anew.
  std::set<Place> fixed_places;
  for (std::size_t v = 0; v < fixed.size(); ++v)
    if (fixed[v])
      fixed_places.emplace(patch.vertices[v].x(), patch.vertices[v].y(), patch.vertices[v].z());
  HalfedgeMesh mesh = to_halfedges(patch);
  const VertexFilter is_fixed = [&](HalfedgeMesh::Vertex_index vertex) {
    return fixed_places.contains(mesh.point(vertex));
  };
  separate_copies(mesh, is_fixed);
  for (int round = 0;; ++round) {
    Faces faces;
    if (round < kRounds) faces = faces_at_open_gaps(mesh, close_gaps, is_fixed);
    const Faces crossing = intersecting_faces(mesh);
    faces.insert(faces.end(), crossing.begin(), crossing.end());
    if (faces.empty()) return from_halfedges(mesh);
    for (int k = 0; k < round && round < kRounds; ++k) faces = with_neighbours(mesh, faces);
    remove_faces(mesh, faces);
    separate_copies(mesh, is_fixed);
  }
}

}  // namespace axial::mesh
