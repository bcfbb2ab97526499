// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// Writes the vertices and faces of a mesh as binary glTF 2.0, without colours and normals. `frame`
// is the frame of the mesh's positions, and the file keeps their numbers. The axes are those of the
// scene. Unless `frame` is the world, its origin is written as geo_offset in the extras of the
// node, as by write_textured_mesh() (io/textured/textured_mesh.h). Error that names the file for a
// mesh without faces, for a vertex that is not finite, if the file would be larger than 4 GiB, and
// if it cannot be written.
void write_mesh_glb(const std::filesystem::path& path, const Mesh& mesh,
                    const LocalFrame& frame = {});

}  // namespace axial::io
