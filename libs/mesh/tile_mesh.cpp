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

std::uint64_t key_of(std::uint32_t from, std::uint32_t to) {
  return std::uint64_t{from} << 32 | to;
}

// The directed edges of the faces of other tiles, ascending.
std::vector<std::uint64_t> other_edges(const Mesh& mesh, const std::vector<bool>& owned) {
  std::vector<std::uint64_t> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (owned[f]) continue;
    const auto& [a, b, c] = mesh.faces[f];
    edges.insert(edges.end(), {key_of(a, b), key_of(b, c), key_of(c, a)});
  }
  std::ranges::sort(edges);
  return edges;
}

}  // namespace

TileMesh owned_part(const Mesh& mesh, const cloud::Tile& tile) {
  std::vector<bool> owned;
  owned.reserve(mesh.faces.size());
  for (const Face& face : mesh.faces) owned.push_back(tile.contains(centroid(mesh, face)));
  const std::vector<std::uint64_t> others = other_edges(mesh, owned);
  TileMesh part;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNoVertex);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!owned[f]) continue;
    Face face = mesh.faces[f];
    for (std::uint32_t& corner : face) {
      std::uint32_t& own = number[corner];
      if (own == kNoVertex) {
        own = static_cast<std::uint32_t>(part.mesh.vertices.size());
        part.mesh.vertices.push_back(mesh.vertices[corner]);
      }
      corner = own;
    }
    part.mesh.faces.push_back(face);
    for (std::size_t k = 0; k < 3; ++k)
      if (std::ranges::binary_search(others, key_of(mesh.faces[f][(k + 1) % 3], mesh.faces[f][k])))
        part.seams.push_back({face[k], face[(k + 1) % 3]});
  }
  return part;
}

}  // namespace axial::mesh
