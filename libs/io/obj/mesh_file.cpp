// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj/mesh_file.h"

#include "base/error.h"
#include "base/file_extension.h"
#include "base/output_name.h"
#include "io/obj/mesh_glb.h"
#include "io/obj/mesh_obj.h"
#include "io/openmvs/scene_files.h"
#include "io/ply/ply.h"

namespace axial::io {
namespace {

bool is_written(const std::string& type) {
  return type == "ply" || type == "obj" || type == "glb";
}

// The type that the user gave, or that the extension of the output asks for.
std::string type_of(const MeshFile& file) {
  const std::string given = lower_case(file.type);
  if (!is_written(given))
    fail("{} {}: must be one of ply, obj, glb", file.name_of("type"), file.type);
  const std::string extension = known_extension(file.output);
  if (file.type_given || extension.empty() || extension == ".mvs") return given;
  if (!is_written(extension.substr(1)))
    fail("{} {}: must end in .ply, .obj or .glb", file.name_of("output"), file.output.string());
  return extension.substr(1);
}

}  // namespace

std::filesystem::path mesh_file(const MeshFile& file) {
  refuse_other_format(file.output, file.name_of("output"));
  const std::string type = type_of(file);
  return mesh_beside(file.scene, file.output, file.ending, type == "ply") += "." + type;
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj")
    write_mesh_obj(path, mesh, frame);
  else if (extension == ".glb")
    write_mesh_glb(path, mesh, frame);
  else
    write_mesh_ply(path, mesh, {frame});
}

}  // namespace axial::io
