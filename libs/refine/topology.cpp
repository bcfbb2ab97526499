// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/vertex_normals.h"

namespace axial::refine {
namespace {

// The other corners of the vertex's faces, each as often as it occurs, in ascending order.
void gather_corners(const Mesh& mesh, const geometry::Lists<>& faces, std::size_t vertex,
                    std::vector<std::uint32_t>& corners) {
  corners.clear();
  for (const std::uint32_t f : faces.of(vertex))
    for (const std::uint32_t v : mesh.faces[f])
      if (v != vertex) corners.push_back(v);
  std::sort(corners.begin(), corners.end());
}

// The mean normals of each vertex and its neighbours.
std::vector<Eigen::Vector3f> mean_normals(std::span<const Eigen::Vector3f> normals,
                                          const Topology& topology) {
  std::vector<Eigen::Vector3f> result(normals.size());
  parallel_for(
      normals.size(),
      [&](std::size_t v) {
        Eigen::Vector3f sum = normals[v];
        for (const std::uint32_t n : topology.neighbours.of(v)) sum += normals[n];
        const float norm = sum.norm();
        result[v] = norm > 0 ? Eigen::Vector3f(sum / norm) : Eigen::Vector3f::Zero();
      },
      kPointGrain);
  return result;
}

}  // namespace

Topology topology_of(const Mesh& mesh) {
  Topology topology;
  topology.faces = geometry::faces_of_vertices(mesh);
  topology.border.assign(mesh.vertices.size(), false);
  geometry::Lists<>& neighbours = topology.neighbours;
  neighbours.begin.reserve(mesh.vertices.size() + 1);
  neighbours.begin.push_back(0);
  neighbours.items.reserve(3 * mesh.faces.size() + mesh.vertices.size());
  std::vector<std::uint32_t> corners;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    gather_corners(mesh, topology.faces, v, corners);
    for (std::size_t i = 0; i < corners.size();) {
      std::size_t end = i;
      while (end < corners.size() && corners[end] == corners[i]) ++end;
      if (end - i != 2) topology.border[v] = true;
      neighbours.items.push_back(corners[i]);
      i = end;
    }
    neighbours.begin.push_back(static_cast<std::uint32_t>(neighbours.items.size()));
  }
  return topology;
}

Shape shape_of(const Mesh& mesh, const Topology& topology) {
  const std::size_t count = mesh.vertices.size();
  Shape shape{mean_normals(geometry::vertex_normals(mesh), topology), std::vector<float>(count),
              std::vector<float>(count)};
  parallel_for(
      count,
      [&](std::size_t v) {
        for (const std::uint32_t f : topology.faces.of(v))
          shape.area[v] += face_vector(mesh, mesh.faces[f]).norm() / 6;
        const auto neighbours = topology.neighbours.of(v);
        float squared = 0;
        for (const std::uint32_t n : neighbours)
          squared += (mesh.vertices[n] - mesh.vertices[v]).squaredNorm();
        shape.edge[v] =
            neighbours.empty() ? 0 : std::sqrt(squared / static_cast<float>(neighbours.size()));
      },
      kPointGrain);
  return shape;
}

}  // namespace axial::refine
