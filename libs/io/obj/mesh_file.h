// SPDX-License-Identifier: GPL-3.0-or-later
// Files of meshes without textures, in one of several formats.
#pragma once

#include <filesystem>
#include <string>

#include "axial/base.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// The path of the mesh file to write.
struct MeshFile {
  std::filesystem::path scene;   // the scene from which the mesh is made
  std::filesystem::path output;  // the value of the user; empty: not given
  std::string type;              // the format
  bool type_given = false;       // the user gave the type
  std::string ending;            // of the default name: "_mesh" for <scene>_mesh.ply
};

// Returns the path of the mesh file. The type is "ply", "obj" or "glb", in upper or lower case. If
// the user did not give the type, the extension of `output` decides, if it is .obj or .glb. The
// rules for the name are those of mesh_beside() (io/openmvs/scene_files.h), with its line of
// `context`. Error that names the setting for another type, and for an output with the extension of
// a format that is not written.
std::filesystem::path mesh_file(const MeshFile& file, const Context& context = {});

// Writes the mesh in the format of the extension of `path`: OBJ, GLB, otherwise PLY. `frame` is the
// frame of the mesh's positions. Positions are written in `frame`, and the file states its origin
// unless `frame` is the world, as by write_textured_mesh() (io/textured/textured_mesh.h). OBJ and
// GLB have no colours. Errors as for write_mesh_ply(). In addition, a GLB gives an Error that names
// the file for a mesh without faces, a vertex that is not finite, and more than 4 GiB.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame);

}  // namespace axial::io
