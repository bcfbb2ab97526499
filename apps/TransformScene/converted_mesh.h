// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh that is written in another format than it is read, or that is not a PLY file, when it is
// moved.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "axial/scene_images.h"
#include "base/context.h"
#include "scene/moved_scene.h"

namespace axial::apps {

struct ConvertedMesh {
  std::filesystem::path input;
  std::vector<std::filesystem::path> outputs;  // the mesh and its other files
  TexturedMesh look;                           // textures and coordinates; `mesh` is empty
};

// Reads the textures of `input` (PLY, OBJ, GLB or glTF), if it has any, and names the files of the
// moved mesh: `output`, whose extension is that of its format (.ply, .obj, .glb or .gltf), and the
// files beside it. Writes nothing. Errors as for io::read_textured_mesh(). In addition, an Error if
// a mesh without textures shall become a .gltf.
ConvertedMesh converted_mesh(const std::filesystem::path& input,
                             const std::filesystem::path& output, const Context& context);

// Moves the mesh and writes it under the names `temporaries`, one for each of `outputs`. Positions
// are written in `move.to`. Normals are left out. Errors as for io::read_mesh_of_scene().
void write_moved(const ConvertedMesh& mesh, const FrameMove& move,
                 std::span<const std::filesystem::path> temporaries, const Context& context);

}  // namespace axial::apps
