// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/mesh_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>

#include "view/little_endian.h"

namespace axial::view {
namespace {

// A vertex of a part: an index into Mesh::vertices, and the texture coordinates.
using Corner = std::tuple<std::uint32_t, std::uint16_t, std::uint16_t>;

std::uint16_t fraction(float pixel, int side) {
  const double share = (static_cast<double>(pixel) + 0.5) / side;
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0)));
}

// Builds one part. `corner_of` returns the corner k of a face. `color`: of all vertices; null: that
// of each vertex.
template <class CornerOf>
MeshPart part_of(const Mesh& mesh, std::span<const std::uint32_t> faces, int texture,
                 const CornerOf& corner_of, const Rgb* color) {
  std::map<Corner, std::uint32_t> numbers;
  std::vector<Corner> corners;
  std::string indices;
  for (const std::uint32_t face : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner corner = corner_of(face, k);
      const auto number = static_cast<std::uint32_t>(corners.size());
      const auto [at, added] = numbers.try_emplace(corner, number);
      if (added) corners.push_back(corner);
      append_u32(indices, at->second);
    }
  }
  MeshPart part{
      corners.size(), faces.size(), texture, color || (texture < 0 && !mesh.colors.empty()), {}};
  for (const auto& [vertex, u, v] : corners)
    for (const float x : mesh.vertices[vertex]) append_f32(part.bytes, x);
  part.bytes += indices;
  for (const auto& [vertex, u, v] : corners) {
    if (texture >= 0) append_u16(part.bytes, u), append_u16(part.bytes, v);
    if (part.colors)
      for (const std::uint8_t value : color ? *color : mesh.colors[vertex])
        part.bytes.push_back(static_cast<char>(value));
  }
  return part;
}

template <class CornerOf>
void append_parts(const Mesh& mesh, std::span<const std::uint32_t> faces, int texture,
                  std::size_t largest, const CornerOf& corner_of, std::vector<MeshPart>& parts,
                  const Rgb* color = nullptr) {
  for (std::size_t begin = 0; begin < faces.size(); begin += largest)
    parts.push_back(part_of(mesh, faces.subspan(begin, std::min(largest, faces.size() - begin)),
                            texture, corner_of, color));
}

}  // namespace

std::vector<MeshPart> mesh_parts(const TexturedMesh& mesh, std::size_t largest) {
  std::vector<std::vector<std::uint32_t>> faces(mesh.textures.size());
  for (std::size_t f = 0; f < mesh.mesh.faces.size(); ++f)
    faces[mesh.texture_of[f]].push_back(static_cast<std::uint32_t>(f));
  const auto corner_of = [&](std::uint32_t face, std::size_t k) -> Corner {
    const cv::Size size = mesh.textures[mesh.texture_of[face]].size();
    const Eigen::Vector2f& uv = mesh.uv[face][k];
    return {mesh.mesh.faces[face][k], fraction(uv.x(), size.width), fraction(uv.y(), size.height)};
  };
  std::vector<MeshPart> parts;
  for (std::size_t t = 0; t < faces.size(); ++t)
    append_parts(mesh.mesh, faces[t], static_cast<int>(t), largest, corner_of, parts);
  return parts;
}

std::vector<MeshPart> mesh_parts(const Mesh& mesh, std::size_t largest) {
  std::vector<std::uint32_t> seen, unseen;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    (mesh.unseen.empty() || !mesh.unseen[f] ? seen : unseen).push_back(f);
  std::vector<MeshPart> parts;
  const auto corner_of = [&](std::uint32_t face, std::size_t k) -> Corner {
    return {mesh.faces[face][k], 0, 0};
  };
  append_parts(mesh, seen, -1, largest, corner_of, parts);
  append_parts(mesh, unseen, -1, largest, corner_of, parts, &kUnseenColor);
  return parts;
}

}  // namespace axial::view
