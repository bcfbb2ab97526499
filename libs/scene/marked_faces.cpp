// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/marked_faces.h"

namespace axial {
namespace {

// Keeps the values of faces without a mark.
template <class Value>
void keep_unmarked(const std::vector<std::uint8_t>& marks, std::vector<Value>& values) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (!marks[f]) values[kept++] = values[f];
  values.resize(kept);
}

// Removes the vertices that no face uses.
void keep_used_vertices(Mesh& mesh) {
  std::vector<std::uint8_t> unused(mesh.vertices.size(), 1);
  for (const auto& face : mesh.faces)
    for (const std::uint32_t v : face) unused[v] = 0;
  std::vector<std::uint32_t> numbers(mesh.vertices.size());
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < numbers.size(); ++v) numbers[v] = unused[v] ? next : next++;
  for (auto& face : mesh.faces)
    for (std::uint32_t& v : face) v = numbers[v];
  if (!mesh.colors.empty()) keep_unmarked(unused, mesh.colors);
  keep_unmarked(unused, mesh.vertices);
}

}  // namespace

std::size_t remove_marked_faces(Mesh& mesh) {
  if (mesh.unseen.empty()) return 0;
  keep_unmarked(mesh.unseen, mesh.faces);
  const std::size_t removed = mesh.unseen.size() - mesh.faces.size();
  keep_used_vertices(mesh);
  mesh.unseen = {};
  return removed;
}

std::size_t remove_marked_faces(TexturedMesh& mesh) {
  if (!mesh.mesh.unseen.empty() && !mesh.textures.empty()) {
    keep_unmarked(mesh.mesh.unseen, mesh.uv);
    keep_unmarked(mesh.mesh.unseen, mesh.texture_of);
  }
  return remove_marked_faces(mesh.mesh);
}

}  // namespace axial
