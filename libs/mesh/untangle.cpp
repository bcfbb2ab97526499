// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <limits>
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
std::vector<Face> intersecting_among(const HalfedgeMesh& mesh, const Faces& among) {
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

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Face>;

template <class Faces>
std::vector<Box> boxes_of(const HalfedgeMesh& mesh, const Faces& faces) {
  std::vector<Box> boxes;
  boxes.reserve(faces.size());
  for (const Face face : faces) {
    CGAL::Bbox_3 box;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      box += mesh.point(vertex).bbox();
    boxes.emplace_back(box, face);
  }
  return boxes;
}

// The faces that intersect another face, ascending. Precondition: each pair of such faces has at
// least one face in `suspects`.
std::vector<Face> intersecting_near(const HalfedgeMesh& mesh, const std::vector<Face>& suspects) {
  std::vector<Box> some = boxes_of(mesh, suspects), all = boxes_of(mesh, mesh.faces());
  std::vector<Face> near = suspects;
  CGAL::box_intersection_d(some.begin(), some.end(), all.begin(), all.end(),
                           [&](const Box&, const Box& hit) { near.push_back(hit.info()); });
  sort_unique(near);
  return intersecting_among(mesh, near);
}

std::vector<Vertex> corners_of(const HalfedgeMesh& mesh, const std::vector<Face>& faces) {
  std::vector<Vertex> corners;
  for (const Face face : faces)
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners.push_back(vertex);
  sort_unique(corners);
  return corners;
}

// By the vertices' indices. Removed vertices have NaN, which equals no position: a new vertex may
// get their index.
std::vector<Eigen::Vector3d> positions(const HalfedgeMesh& mesh) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> result(mesh.num_vertices(), Eigen::Vector3d::Constant(kNone));
  for (const auto vertex : mesh.vertices()) result[vertex.idx()] = position(mesh, vertex);
  return result;
}

// Adds to `faces` the faces with a corner that was not at the same place in `before`.
void add_moved_faces(const HalfedgeMesh& mesh, const std::vector<Eigen::Vector3d>& before,
                     std::vector<Face>& faces) {
  for (const auto face : mesh.faces())
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      if (vertex.idx() >= before.size() || before[vertex.idx()] != position(mesh, vertex))
        faces.push_back(face);
  sort_unique(faces);
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

std::vector<Face> intersecting_faces(const HalfedgeMesh& mesh) {
  return intersecting_among(mesh, mesh.faces());
}

std::vector<Face> with_neighbours(const HalfedgeMesh& mesh, std::vector<Face> faces) {
  for (const Vertex vertex : corners_of(mesh, faces))
    for (const auto face : mesh.faces_around_target(mesh.halfedge(vertex)))
      if (face != HalfedgeMesh::null_face()) faces.push_back(face);
  sort_unique(faces);
  return faces;
}

void separate_copies(HalfedgeMesh& mesh, const VertexFilter& fixed) {
  std::vector<Vertex> order;
  for (const auto vertex : mesh.vertices())
    if (!mesh.is_isolated(vertex) && !(fixed && fixed(vertex))) order.push_back(vertex);
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
  std::vector<Face> faces = intersecting_faces(mesh);
  if (faces.empty()) return 0;
  // The other sheets of the surface near a face are found only if they intersect something already.
  // The check of the faces that moved against all faces finds the rest.
  const std::vector<Face> near = with_neighbours(mesh, with_neighbours(mesh, faces));
  std::vector<Face> suspects = faces;
  std::vector<Eigen::Vector3d> before = positions(mesh);
  for (int round = 0; round < kRounds && !faces.empty(); ++round) {
    smooth_around(mesh, faces);
    faces = intersecting_among(mesh, near);
  }
  std::size_t removed = 0;
  for (;;) {
    add_moved_faces(mesh, before, suspects);
    faces = intersecting_near(mesh, suspects);
    if (faces.empty()) return removed;
    before = positions(mesh);
    for (const Face face : faces)
      if (!mesh.is_removed(face)) CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
    removed += faces.size() + remove_spikes(mesh);
    suspects.clear();
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
