// SPDX-License-Identifier: GPL-3.0-or-later
// Files of meshes without textures, in one of several formats.
#pragma once

#include <filesystem>
#include <string>

#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// Returns the path of the mesh file to write. `path` is the value of the option -o. `type` is the
// value of the option --export-type, "ply" or "obj". `type_given` is true if the user gave the
// type. If the user did not give the type and `path` ends in .obj, the type is "obj". The type
// becomes the extension of the result: it replaces the extensions .ply, .obj and .mvs, and is
// appended to any other path. `type` is not checked.
std::filesystem::path mesh_file(std::filesystem::path path, std::string type, bool type_given);

// Writes the mesh as OBJ if the extension of `path` is .obj, otherwise as PLY. `frame` is the frame
// of the mesh's positions. Positions are written in `frame`, and the file states its origin unless
// `frame` is the world. OBJ has no colours. Errors as for write_mesh_ply() and write_mesh_obj().
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame);

}  // namespace axial::io
