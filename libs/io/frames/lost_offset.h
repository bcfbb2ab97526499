// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of clouds and meshes that belong to a scene but have lost its offset.
#pragma once

#include <filesystem>

#include "axial/base.h"
#include "scene/local_frame.h"

namespace axial::io {

// The rule for meshes and clouds that state no offset. Editors and other programs drop the offset,
// and write either local coordinates or world coordinates. Returns true if the positions of the
// file are in `frame` although the file states no offset: if the first stored position is nearer to
// the origin of its coordinates than to the origin of `frame` in the world. False if `frame` is the
// world, and for a file without vertices. `path`: PLY, OBJ, GLB or glTF. Errors as for the readers
// of these formats.
bool is_without_offset(const LocalFrame& frame, const std::filesystem::path& path);

// The frame of the stored positions of a PLY that belongs to a scene in `frame`: `frame` if
// is_without_offset(), otherwise that of the comment geo_offset, or the world. Errors as for
// ply_place().
LocalFrame frame_of_positions(const LocalFrame& frame, const std::filesystem::path& ply);

// States in a line of `context` that the positions of `file` count as positions in the frame of its
// scene.
void tell_lost_offset(const std::filesystem::path& file, const LocalFrame& frame,
                      const Context& context);

}  // namespace axial::io
