// SPDX-License-Identifier: GPL-3.0-or-later
// Files of meshes without textures, in one of several formats.
#pragma once

#include <filesystem>
#include <string>

#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// The file to write for the options -o and --export-type (`type`, "ply" or "obj"). If the type was
// not given, the extension .obj of `path` chooses it. The extension of a mesh or of a scene is
// replaced; to any other name the extension is appended.
std::filesystem::path mesh_file(std::filesystem::path path, std::string type, bool type_given);

// Writes the mesh in the format of the extension, .ply or .obj, with positions relative to `frame`.
// Errors as for write_mesh_ply.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame);

}  // namespace axial::io
