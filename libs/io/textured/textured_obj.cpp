// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <iterator>

#include "textured/private/textured_writers.h"

namespace axial::io {

std::string textured_obj(const TexturedMesh& mesh, const std::string& materials,
                         const LocalFrame& frame) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (!frame.is_world())
    fmt::format_to(out, "# geo_offset {} {} {}\n", frame.origin.x(), frame.origin.y(),
                   frame.origin.z());
  fmt::format_to(out, "mtllib {}\n", materials);
  for (const Eigen::Vector3f& v : mesh.mesh.vertices)
    fmt::format_to(out, "v {} {} {}\n", v.x(), v.y(), v.z());
  std::size_t before = 1;  // indices begin at 1
  CornerUnifier unifier(mesh);
  for (std::uint32_t k = 0; k < mesh.textures.size(); ++k) {
    const UnifiedCorners corners = unifier.corners_of(k);
    if (corners.faces.empty()) continue;
    for (const Eigen::Vector2f& corner : corners.uv) {
      const Eigen::Vector2f uv = relative(corner, mesh.textures[k].size());
      fmt::format_to(out, "vt {} {}\n", uv.x(), 1 - uv.y());
    }
    fmt::format_to(out, "g material_{}\nusemtl material_{}\n", k, k);
    for (const auto& face : corners.faces) {
      text.push_back('f');
      for (const std::uint32_t corner : face)
        fmt::format_to(out, " {}/{}", corners.vertex[corner] + 1, corner + before);
      text.push_back('\n');
    }
    before += corners.uv.size();
  }
  return fmt::to_string(text);
}

std::string textured_mtl(const std::vector<std::string>& textures) {
  std::string text;
  for (std::size_t k = 0; k < textures.size(); ++k)
    text += fmt::format("newmtl material_{}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n", k,
                        textures[k]);
  return text;
}

}  // namespace axial::io
