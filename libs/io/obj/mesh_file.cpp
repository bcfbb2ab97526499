// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj/mesh_file.h"

#include "io/obj/mesh_obj.h"
#include "io/ply/ply.h"

namespace axial::io {

std::filesystem::path mesh_file(std::filesystem::path path, std::string type, bool type_given) {
  const std::string extension = path.extension().string();
  if (!type_given && extension == ".obj") type = "obj";
  if (extension == ".mvs" || extension == ".ply" || extension == ".obj") path.replace_extension();
  return path += "." + type;
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  if (path.extension() == ".obj")
    write_mesh_obj(path, mesh, frame);
  else
    write_mesh_ply(path, mesh, {frame});
}

}  // namespace axial::io
