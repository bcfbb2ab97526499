// SPDX-License-Identifier: GPL-3.0-or-later
// Reads meshes of all formats that belong to a scene, also meshes that lost their offset.
#pragma once

#include <filesystem>

#include "scene/local_frame.h"
#include "scene/textured_mesh.h"

namespace axial::io {

// The rule for meshes and clouds that state no offset. Editors and other programs drop the offset,
// and write either local coordinates or world coordinates. Returns true if the positions of the
// file are in `frame` although the file states no offset: if the first stored position is nearer to
// the origin of its coordinates than to the origin of `frame` in the world. False if `frame` is the
// world, and for a file without vertices. `path`: PLY, OBJ, GLB or glTF. Errors as for the readers
// of these formats.
bool is_without_offset(const LocalFrame& frame, const std::filesystem::path& path);

// States in the log that the positions of `file` count as positions in the frame of its scene.
void tell_lost_offset(const std::filesystem::path& file, const LocalFrame& frame);

// Reads a mesh of a scene in `frame` as read_textured_mesh() does (io/textured/textured_mesh.h).
// The positions of the result are in `frame`. The positions of a file for which is_without_offset()
// is true stay as they are, and the log states this. read_mesh_of_scene() (point_source.h) reads
// the shape alone.
TexturedMesh read_textured_mesh_of_scene(const LocalFrame& frame,
                                         const std::filesystem::path& path);

}  // namespace axial::io
