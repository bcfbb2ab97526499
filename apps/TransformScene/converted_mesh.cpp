// SPDX-License-Identifier: GPL-3.0-or-later
#include "converted_mesh.h"

#include "base/error.h"
#include "base/file_extension.h"
#include "evaluate/alignment.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {

namespace fs = std::filesystem;

namespace {

io::TexturedFormat format_of(const fs::path& file) {
  return io::textured_format(lower_extension(file).substr(1)).value_or(io::TexturedFormat::ply);
}

}  // namespace

ConvertedMesh converted_mesh(const fs::path& input, const fs::path& output,
                             const Context& context) {
  ConvertedMesh mesh{input, {output}, {}};
  if (!io::is_textured_mesh(input)) {
    if (format_of(output) == io::TexturedFormat::gltf)
      fail_in(input, "has no textures, and is not written as gltf: choose ply, obj or glb");
    return mesh;
  }
  mesh.look = io::read_textured_mesh(input, {}, context);
  mesh.look.mesh = {};  // its positions are read again in the frame of the scene
  mesh.outputs = io::textured_files(output, format_of(output), mesh.look.textures.size());
  return mesh;
}

void write_moved(const ConvertedMesh& mesh, const FrameMove& move,
                 std::span<const fs::path> temporaries, const Context& context) {
  Mesh moved = io::read_mesh_of_scene(move.from, mesh.input, context);
  evaluate::apply(move.similarity, moved);
  for (std::size_t i = 0; i < moved.vertices.size(); ++i)
    if (!moved.vertices[i].allFinite())
      fail_in(mesh.input, "vertex {} has no finite position after the transformation", i);
  if (mesh.look.textures.empty()) return io::write_mesh(temporaries[0], moved, move.to);
  TexturedMesh textured = mesh.look;
  textured.mesh = std::move(moved);
  io::write_textured_as(temporaries, mesh.outputs[0], textured, format_of(mesh.outputs[0]),
                        move.to);
}

}  // namespace axial::apps
