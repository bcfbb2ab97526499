// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a PLY file by a similarity and keeps everything else that the file holds.
#pragma once

#include <filesystem>

#include "scene/moved_scene.h"

namespace axial::io {

// Writes `output`: the cloud or mesh of `input` after `move`. These vertex properties change: x y
// z; nx ny nz, which turn; and the float property `error`, which is a length and is multiplied by
// the scale. All other properties, elements (faces, texture coordinates) and comments stay. The
// result is binary little-endian.
//
// Positions of `input` are relative to the file's comment geo_offset. Without this comment they are
// in the world or in `move.from`, whichever origin is nearer to the first vertex, because OpenMVS's
// programs keep coordinates but drop comments. Positions are written in `move.to` with the comment;
// but float64 positions without a comment are world coordinates, and are written as such.
//
// Error that names the file for a malformed or truncated file, a file without vertices, positions
// that are not float, or a position that is not finite before or after the move.
void transform_ply(const std::filesystem::path& input, const std::filesystem::path& output,
                   const FrameMove& move);

// The frame of the positions of a PLY file that belongs to a scene in `frame`: by the rule above.
LocalFrame frame_of_positions(const std::filesystem::path& ply, const LocalFrame& frame);

}  // namespace axial::io
