// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/mesh_tiles.h"

#include <algorithm>

#include "base/parallel.h"
#include "geometry/faces.h"

namespace axial::texture {
namespace {

// The numbers of vertices of the tiles are equal enough with this number of vertices.
constexpr std::size_t kSampledVertices = 100'000;

std::vector<Eigen::Vector3f> some_vertices(const Mesh& mesh) {
  const std::size_t step = mesh.vertices.size() / kSampledVertices + 1;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) points.push_back(mesh.vertices[i]);
  return points;
}

std::uint32_t tile_at(std::span<const cloud::Tile> boxes, const Eigen::Vector3d& point) {
  const auto found =
      std::ranges::find_if(boxes, [&](const cloud::Tile& box) { return box.contains(point); });
  return static_cast<std::uint32_t>(found - boxes.begin());
}

}  // namespace

FaceTiles divide_faces(const Mesh& mesh, std::size_t count, const Eigen::Matrix3d& axes) {
  FaceTiles tiles;
  if (count == 1) {
    tiles.boxes.resize(1);
    return tiles;
  }
  tiles.boxes = cloud::make_tiles(some_vertices(mesh), count, axes);
  tiles.of_face.resize(mesh.faces.size());
  parallel_for(
      mesh.faces.size(),
      [&](std::size_t face) {
        tiles.of_face[face] = tile_at(tiles.boxes, geometry::middle_of(mesh, face));
      },
      kPointGrain);
  return tiles;
}

std::uint64_t bytes_to_divide(const Mesh& mesh, std::size_t count) {
  if (count == 1) return 0;
  // The sampled vertices, the same along the axes, and their coordinates along one axis.
  constexpr std::uint64_t kOfSample =
      2 * sizeof(Eigen::Vector3f) + 2 * sizeof(Eigen::Vector3d) + 16;
  return std::min(mesh.vertices.size(), kSampledVertices) * kOfSample +
         mesh.faces.size() * sizeof(std::uint32_t);
}

MeshPart mesh_of_faces(const Mesh& mesh, std::span<const std::uint32_t> faces) {
  MeshPart part;
  part.vertices.reserve(3 * faces.size());
  for (const std::uint32_t f : faces)
    part.vertices.insert(part.vertices.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  std::ranges::sort(part.vertices);
  part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
  part.vertices.shrink_to_fit();
  part.mesh.vertices.reserve(part.vertices.size());
  for (const std::uint32_t v : part.vertices) part.mesh.vertices.push_back(mesh.vertices[v]);
  for (const std::uint32_t f : faces)
    if (!mesh.unseen.empty()) part.mesh.unseen.push_back(mesh.unseen[f]);
  part.mesh.faces.resize(faces.size());
  parallel_for(
      faces.size(),
      [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k)
          part.mesh.faces[i][k] = static_cast<std::uint32_t>(
              std::ranges::lower_bound(part.vertices, mesh.faces[faces[i]][k]) -
              part.vertices.begin());
      },
      kPointGrain);
  return part;
}

std::uint64_t bytes_of_part(std::uint64_t vertices, std::uint64_t faces) {
  // The corners while they are sorted, with a copy that is cut; then positions and faces.
  const std::uint64_t sorted = faces * 3 * sizeof(std::uint32_t);
  const std::uint64_t indices = vertices * sizeof(std::uint32_t);
  return indices + std::max(sorted, vertices * sizeof(Eigen::Vector3f) + faces * (3 * 4 + 1));
}

std::vector<std::uint32_t> faces_of(const FaceTiles& tiles, std::size_t tile) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < tiles.of_face.size(); ++f)
    if (tiles.of_face[f] == tile) faces.push_back(f);
  return faces;
}

}  // namespace axial::texture
