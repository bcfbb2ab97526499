// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/point_distances.h"

#include <cmath>

#include "base/parallel.h"
#include "geometry/point_tree.h"

namespace axial::mesh {
namespace {

constexpr std::size_t kPointsPerFace = 4;

}  // namespace

std::size_t enough_points(std::size_t faces) {
  return kPointsPerFace * faces;
}

std::vector<float> distances_to_points(const Mesh& mesh, std::span<const Eigen::Vector3f> points) {
  const geometry::PointSet set{points};
  const geometry::PointTree<> tree(3, set);
  std::vector<float> distances(mesh.faces.size());
  parallel_for(
      distances.size(),
      [&](std::size_t f) {
        const auto& [a, b, c] = mesh.faces[f];
        const Eigen::Vector3f middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
        std::uint32_t nearest = 0;
        float squared = 0;
        tree.knnSearch(middle.data(), 1, &nearest, &squared);
        distances[f] = std::sqrt(squared);
      },
      kPointGrain);
  return distances;
}

std::uint64_t bytes_of_distances(const Mesh& mesh) {
  constexpr std::uint64_t kPointInTree = 20;  // its number, and its part of the nodes
  return mesh.faces.size() * (kPointsPerFace * kPointInTree + sizeof(float));
}

}  // namespace axial::mesh
