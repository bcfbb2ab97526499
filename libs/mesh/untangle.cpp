// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
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

template <class Index>
void sort_unique(std::vector<Index>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

// The faces of `among` that intersect another face of `among`, ascending.
template <class Faces>
std::vector<Face> intersecting_faces(const HalfedgeMesh& mesh, const Faces& among) {
  std::vector<std::pair<Face, Face>> pairs;
  pmp::self_intersections<CGAL::Sequential_tag>(among, mesh, std::back_inserter(pairs));
  std::vector<Face> faces;
  for (const auto& [a, b] : pairs) {
    faces.push_back(a);
    faces.push_back(b);
  }
  sort_unique(faces);
  return faces;
}

std::vector<Vertex> corners_of(const HalfedgeMesh& mesh, const std::vector<Face>& faces) {
  std::vector<Vertex> corners;
  for (const Face face : faces)
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners.push_back(vertex);
  sort_unique(corners);
  return corners;
}

// Adds the faces that share a corner with `faces`.
std::vector<Face> with_neighbours(const HalfedgeMesh& mesh, std::vector<Face> faces) {
  for (const Vertex vertex : corners_of(mesh, faces))
    for (const auto face : mesh.faces_around_target(mesh.halfedge(vertex)))
      if (face != HalfedgeMesh::null_face()) faces.push_back(face);
  sort_unique(faces);
  return faces;
}

// Moves the corners of `faces` half of the way to the mean of their neighbours.
void smooth_around(HalfedgeMesh& mesh, const std::vector<Face>& faces) {
  const std::vector<Vertex> corners = corners_of(mesh, faces);
  std::vector<Eigen::Vector3d> moved;
  moved.reserve(corners.size());
  for (const Vertex vertex : corners)
    moved.emplace_back(0.5 * (position(mesh, vertex) + mean_of_neighbours(mesh, vertex)));
  for (std::size_t i = 0; i < corners.size(); ++i) move_to(mesh, corners[i], moved[i]);
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

std::size_t untangle(HalfedgeMesh& mesh) {
  constexpr int kRounds = 8;
  std::vector<Face> faces = intersecting_faces(mesh, mesh.faces());
  if (faces.empty()) return 0;
  // The other sheets of the surface near a face are found only if they intersect something already.
  // The check of all faces at the end finds the rest.
  const std::vector<Face> near = with_neighbours(mesh, with_neighbours(mesh, faces));
  for (int round = 0; round < kRounds && !faces.empty(); ++round) {
    smooth_around(mesh, faces);
    faces = intersecting_faces(mesh, near);
  }
  std::size_t removed = 0;
  for (;;) {
    faces = intersecting_faces(mesh, mesh.faces());
    if (faces.empty()) return removed;
    for (const Face face : faces)
      if (!mesh.is_removed(face)) CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
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
