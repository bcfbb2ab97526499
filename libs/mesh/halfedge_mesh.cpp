// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/halfedge_mesh.h"

#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>

#include <vector>

namespace axial::mesh {
namespace {

// Without `volatile`, GCC 12 removes the conversion of two neighbouring coordinates to float and
// back (with -O3 it makes one vector conversion of them, which it takes for none).
double rounded_to_float(double x) {
  const volatile auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}

}  // namespace

namespace pmp = CGAL::Polygon_mesh_processing;

HalfedgeMesh to_halfedges(const Mesh& mesh) {
  std::vector<HalfedgeKernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::array<std::size_t, 3>> faces;
  faces.reserve(mesh.faces.size());
  for (const auto& face : mesh.faces)
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
      faces.push_back({face[0], face[1], face[2]});
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) {
    pmp::merge_duplicate_polygons_in_polygon_soup(points, faces);
    pmp::orient_polygon_soup(points, faces);
  }
  HalfedgeMesh result;
  pmp::polygon_soup_to_polygon_mesh(points, faces, result);
  pmp::duplicate_non_manifold_vertices(result);
  return result;
}

Mesh from_halfedges(HalfedgeMesh& mesh) {
  for (const auto vertex : mesh.vertices())
    if (mesh.is_isolated(vertex)) mesh.remove_vertex(vertex);
  mesh.collect_garbage();
  Mesh result;
  result.vertices.reserve(mesh.number_of_vertices());
  result.faces.reserve(mesh.number_of_faces());
  for (const auto vertex : mesh.vertices())
    result.vertices.emplace_back(position(mesh, vertex).cast<float>());
  for (const auto face : mesh.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t k = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners[k++] = static_cast<std::uint32_t>(vertex.idx());
    result.faces.push_back(corners);
  }
  return result;
}

Eigen::Vector3d mean_of_neighbours(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto neighbour : mesh.vertices_around_target(mesh.halfedge(vertex))) {
    sum += position(mesh, neighbour);
    ++count;
  }
  return sum / count;
}

void move_to(HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex, const Eigen::Vector3d& to) {
  mesh.point(vertex) = {rounded_to_float(to.x()), rounded_to_float(to.y()),
                        rounded_to_float(to.z())};
}

}  // namespace axial::mesh
