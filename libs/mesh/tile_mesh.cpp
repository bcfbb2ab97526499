// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tile_mesh.h"

#include <algorithm>
#include <limits>

namespace axial::mesh {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

using Face = std::array<std::uint32_t, 3>;

Eigen::Vector3d centroid(const Mesh& mesh, const Face& face) {
  std::array<Eigen::Vector3f, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[face[k]];
  std::ranges::sort(corners, [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::ranges::lexicographical_compare(a, b);
  });
  return (corners[0].cast<double>() + corners[1].cast<double>() + corners[2].cast<double>()) / 3;
}

}  // namespace

MeshPart part_of(const Mesh& mesh, const std::vector<bool>& taken) {
  MeshPart part;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNoVertex);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!taken[f]) continue;
    Face face = mesh.faces[f];
    for (std::uint32_t& corner : face) {
      std::uint32_t& own = number[corner];
      if (own == kNoVertex) {
        own = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(corner);
        part.mesh.vertices.push_back(mesh.vertices[corner]);
      }
      corner = own;
    }
    part.mesh.faces.push_back(face);
  }
  return part;
}

std::vector<std::uint64_t> directed_edges(const Mesh& mesh, const std::vector<bool>& taken) {
  std::vector<std::uint64_t> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!taken[f]) continue;
    const auto& [a, b, c] = mesh.faces[f];
    edges.insert(edges.end(), {directed(a, b), directed(b, c), directed(c, a)});
  }
  std::ranges::sort(edges);
  return edges;
}

TileMesh owned_part(const Mesh& mesh, const cloud::Tile& tile) {
  std::vector<bool> owned, others;
  for (const Face& face : mesh.faces) {
    owned.push_back(tile.contains(centroid(mesh, face)));
    others.push_back(!owned.back());
  }
  const std::vector<std::uint64_t> edges = directed_edges(mesh, others);
  MeshPart part = part_of(mesh, owned);
  TileMesh result;
  for (const Face& face : part.mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = face[k], to = face[(k + 1) % 3];
      if (std::ranges::binary_search(edges, directed(part.vertices[to], part.vertices[from])))
        result.seams.push_back({from, to});
    }
  result.mesh = std::move(part.mesh);
  return result;
}

}  // namespace axial::mesh
