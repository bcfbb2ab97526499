// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// Writes the vertices and faces of a mesh in Wavefront's OBJ format, without colours. `frame` is
// the frame of the mesh's positions, and the file keeps their numbers. Unless `frame` is the world,
// its origin is written as a comment: "# geo_offset X Y Z". Coordinates have nine significant
// digits, so that reading gives the same float. Error that names the file if it cannot be written.
void write_mesh_obj(const std::filesystem::path& path, const Mesh& mesh,
                    const LocalFrame& frame = {});

}  // namespace axial::io
