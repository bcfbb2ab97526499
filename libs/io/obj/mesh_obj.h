// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// Writes the vertices and faces of a mesh in Wavefront's OBJ format, without colours. Positions are
// relative to `frame`, which a comment "geo_offset X Y Z" names unless it is the world. They have
// nine significant digits, so that reading gives the same float.
void write_mesh_obj(const std::filesystem::path& path, const Mesh& mesh,
                    const LocalFrame& frame = {});

}  // namespace axial::io
