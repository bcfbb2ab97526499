// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/check_mesh.h"

#include "base/error.h"

namespace axial {

void check_mesh(const Mesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  if (mesh.faces.empty()) fail("the mesh has no faces");
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f])
      if (v >= vertices) fail("face {} refers to vertex {}, but there are {}", f, v, vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    if (!mesh.vertices[v].allFinite()) fail("vertex {} is not finite", v);
  if (!mesh.colors.empty() && mesh.colors.size() != vertices)
    fail("the mesh has {} colours, but {} vertices", mesh.colors.size(), vertices);
  if (!mesh.unseen.empty() && mesh.unseen.size() != mesh.faces.size())
    fail("the mesh has {} marks of faces, but {} faces", mesh.unseen.size(), mesh.faces.size());
}

}  // namespace axial
