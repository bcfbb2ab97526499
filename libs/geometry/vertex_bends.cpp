// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_bends.h"

#include <cstddef>

#include "geometry/vertex_normals.h"

namespace axial::geometry {
namespace {

std::vector<float> bends_along(const Mesh& mesh, const std::vector<Eigen::Vector3f>& normals) {
  std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(mesh.vertices.size(), 0);
  for (const auto& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
        // From the vertex, so that numbers far from the origin keep their digits.
        sums[face[k]] += (mesh.vertices[face[other]] - mesh.vertices[face[k]]).cast<double>();
        ++counts[face[k]];
      }
  std::vector<float> bends(mesh.vertices.size(), 0.f);
  for (std::size_t v = 0; v < bends.size(); ++v)
    if (counts[v] > 0)
      bends[v] = static_cast<float>(sums[v].dot(normals[v].cast<double>()) / counts[v]);
  return bends;
}

}  // namespace

std::vector<float> vertex_bends(const Mesh& mesh) {
  return bends_along(mesh, vertex_normals(mesh));
}

Mesh smoothed(const Mesh& mesh) {
  constexpr float kNeighbours = 6;  // of a vertex in a mesh of triangles
  const std::vector<Eigen::Vector3f> normals = vertex_normals(mesh);
  const std::vector<float> bends = bends_along(mesh, normals);
  Mesh result = mesh;
  for (std::size_t v = 0; v < bends.size(); ++v)
    result.vertices[v] += kNeighbours / (kNeighbours + 1) * bends[v] * normals[v];
  return result;
}

}  // namespace axial::geometry
