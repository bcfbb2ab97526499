// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a PLY file by a similarity and keeps everything else that the file holds.
#pragma once

#include <filesystem>

#include "scene/moved_scene.h"

namespace axial::io {

// Transforms the cloud or mesh of `input` by `move` and writes it to `output`, in binary
// little-endian. Three kinds of vertex properties change. The positions x y z are transformed. The
// normals nx ny nz are rotated. The float property `error` is a length and is multiplied by the
// scale. All other properties, all other elements (faces, texture coordinates) and all comments
// except geo_offset stay as they are.
//
// The frame of the positions of `input` follows from frame_of_positions with `move.from`. Positions
// are written in `move.to`, with a comment geo_offset unless `move.to` is the world. Exception: if
// the positions of `input` are float64 in the world and the file has no comment geo_offset, they
// are written as float64 in the world, without the comment.
//
// Error that names the file for a malformed or truncated file, a file without vertices, positions
// that are neither float32 nor float64, or a position that is not finite after the move.
void transform_ply(const std::filesystem::path& input, const std::filesystem::path& output,
                   const FrameMove& move);

// Returns the frame of the positions of a PLY file that belongs to a scene in `frame`. First, if
// the file has a comment geo_offset that is not zero, its point is the origin. Otherwise the file
// does not state the frame, because OpenMVS's programs keep coordinates but drop comments. The
// positions are then taken to be in the world or in `frame`, whichever of the two origins is nearer
// to the stored first vertex. Errors as for ply_place.
LocalFrame frame_of_positions(const std::filesystem::path& ply, const LocalFrame& frame);

}  // namespace axial::io
