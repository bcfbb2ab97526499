// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj/mesh_obj.h"

#include <fmt/format.h>

#include <iterator>

#include "base/atomic_file.h"

namespace axial::io {

void write_mesh_obj(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const Eigen::Vector3d& o = frame.origin;
  if (!frame.is_world()) fmt::format_to(out, "# geo_offset {} {} {}\n", o.x(), o.y(), o.z());
  for (const Eigen::Vector3f& v : mesh.vertices)
    fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", v.x(), v.y(), v.z());
  for (const auto& face : mesh.faces)
    fmt::format_to(out, "f {} {} {}\n", face[0] + 1, face[1] + 1, face[2] + 1);
  write_atomically(path, {text.data(), text.size()});
}

}  // namespace axial::io
