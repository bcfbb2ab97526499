// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/split.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace axial::refine {
namespace {

using Face = std::array<std::uint32_t, 3>;

// The new vertices in the middle of edges.
class Middles {
 public:
  explicit Middles(Mesh& mesh) : mesh_(mesh) {}

  void split(std::uint32_t a, std::uint32_t b) {
    const auto [place, added] =
        of_.try_emplace(key(a, b), static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (!added) return;
    const Eigen::Vector3f middle = (mesh_.vertices[a] + mesh_.vertices[b]) / 2;
    mesh_.vertices.push_back(middle);
    if (mesh_.colors.empty()) return;
    Rgb color;
    for (std::size_t k = 0; k < 3; ++k)
      color[k] = static_cast<std::uint8_t>((mesh_.colors[a][k] + mesh_.colors[b][k]) / 2);
    mesh_.colors.push_back(color);
  }

  // The vertex in the middle, or the corner `none` if the edge is whole.
  std::uint32_t find(std::uint32_t a, std::uint32_t b, std::uint32_t none) const {
    const auto place = of_.find(key(a, b));
    return place == of_.end() ? none : place->second;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }

  Mesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> of_;
};

// Appends the parts of a face whose edges may be split.
void append_parts(const Face& face, const Middles& middles, std::vector<Face>& parts) {
  constexpr std::uint32_t kWhole = 0xFFFFFFFFu;
  std::array<std::uint32_t, 3> middle;  // of the edge from corner k to the next one
  for (std::size_t k = 0; k < 3; ++k) middle[k] = middles.find(face[k], face[(k + 1) % 3], kWhole);
  const auto split = 3 - std::count(middle.begin(), middle.end(), kWhole);
  // Begin at an edge that is split, after one that is whole if there is one.
  std::size_t i = 0;
  while (split > 0 && (middle[i] == kWhole || (split < 3 && middle[(i + 2) % 3] != kWhole))) ++i;
  const std::uint32_t a = face[i % 3], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
  const std::uint32_t ab = middle[i % 3], bc = middle[(i + 1) % 3], ca = middle[(i + 2) % 3];
  if (split == 0)
    parts.push_back(face);
  else if (split == 1)
    parts.insert(parts.end(), {{a, ab, c}, {ab, b, c}});
  else if (split == 2)
    parts.insert(parts.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
  else
    parts.insert(parts.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
}

}  // namespace

std::size_t split_faces(Mesh& mesh, const std::vector<bool>& marked) {
  const std::size_t before = mesh.faces.size();
  Middles middles(mesh);
  for (std::size_t f = 0; f < before; ++f)
    for (std::size_t k = 0; k < 3 && marked[f]; ++k)
      middles.split(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]);
  std::vector<Face> faces;
  faces.reserve(before);
  for (const Face& face : mesh.faces) append_parts(face, middles, faces);
  mesh.faces = std::move(faces);
  return mesh.faces.size() - before;
}

}  // namespace axial::refine
