// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <span>
#include <vector>

#include "private/halfedge_mesh.h"

namespace axial::mesh {
namespace pmp = CGAL::Polygon_mesh_processing;
namespace {

using Vertex = HalfedgeMesh::Vertex_index;
using Face = HalfedgeMesh::Face_index;

// The faces that intersect another face, ascending.
std::vector<Face> intersecting_faces(const HalfedgeMesh& mesh) {
  std::vector<std::pair<Face, Face>> pairs;
  pmp::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(pairs));
  std::vector<Face> faces;
  for (const auto& [a, b] : pairs) {
    faces.push_back(a);
    faces.push_back(b);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

Eigen::Vector3d mean_of_neighbours(const HalfedgeMesh& mesh, Vertex vertex) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto neighbour : mesh.vertices_around_target(mesh.halfedge(vertex))) {
    sum += position(mesh, neighbour);
    ++count;
  }
  return sum / count;
}

}  // namespace

void separate_copies(HalfedgeMesh& mesh) {
  std::vector<Vertex> order;
  for (const auto vertex : mesh.vertices())
    if (!mesh.is_isolated(vertex)) order.push_back(vertex);
  std::sort(order.begin(), order.end(), [&](Vertex a, Vertex b) {
    return std::pair(mesh.point(a), a) < std::pair(mesh.point(b), b);
  });
  std::vector<std::pair<Vertex, Eigen::Vector3d>> moves;
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    if (mesh.point(order[i]) != mesh.point(order[i + 1])) continue;
    for (const Vertex vertex : {order[i], order[i + 1]}) {
      const Eigen::Vector3d from = position(mesh, vertex);
      moves.emplace_back(vertex, from + 0.01 * (mean_of_neighbours(mesh, vertex) - from));
    }
  }
  for (const auto& [vertex, to] : moves) move_to(mesh, vertex, to);
}

std::size_t untangle(HalfedgeMesh& mesh, std::span<const Eigen::Vector3d> before) {
  if (!before.empty()) {
    for (const Face face : intersecting_faces(mesh))
      for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
        if (vertex.idx() < before.size()) move_to(mesh, vertex, before[vertex.idx()]);
  }
  std::size_t removed = 0;
  for (;;) {
    const std::vector<Face> faces = intersecting_faces(mesh);
    if (faces.empty()) return removed;
    for (const Face face : faces) CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
    removed += faces.size() + remove_spikes(mesh);
  }
}

std::size_t remove_spikes(HalfedgeMesh& mesh) {
  std::vector<Face> queue(mesh.faces().begin(), mesh.faces().end());
  std::size_t removed = 0;
  while (!queue.empty()) {
    const Face face = queue.back();
    queue.pop_back();
    if (mesh.is_removed(face)) continue;
    std::vector<Face> around;
    for (const auto half : mesh.halfedges_around_face(mesh.halfedge(face)))
      if (!mesh.is_border(mesh.opposite(half))) around.push_back(mesh.face(mesh.opposite(half)));
    if (around.size() > 1) continue;
    CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
    ++removed;
    queue.insert(queue.end(), around.begin(), around.end());
  }
  pmp::duplicate_non_manifold_vertices(mesh);
  separate_copies(mesh);
  return removed;
}

}  // namespace axial::mesh
