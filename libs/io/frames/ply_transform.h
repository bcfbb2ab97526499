// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a PLY file by a similarity and keeps everything else that the file holds.
#pragma once

#include <filesystem>

#include "scene/moved_scene.h"

namespace axial::io {

// Transforms the cloud or mesh of `input` by `move` and writes it to `output`, in binary
// little-endian. An existing file is replaced. Three kinds of vertex properties change. The
// positions x y z are transformed. The normals nx ny nz are rotated. The float property `error` is
// a length and is multiplied by the scale. All other properties, all other elements (faces, texture
// coordinates) and all comments except geo_offset stay as they are.
//
// The positions of `input` are in the frame whose origin its comment geo_offset states. Without
// such a comment, or with one that is zero, the file does not state the frame, because OpenMVS's
// programs keep coordinates but drop comments. The frame is then the world or `move.from`,
// whichever has its origin nearer to the first vertex. Positions are written in `move.to`, with a
// comment geo_offset unless `move.to` is the world. Exception: if `input` has float64 positions in
// the world and no comment geo_offset, positions are written as float64 in the world, without a
// comment geo_offset.
//
// Error that names the file for a malformed or truncated file, a file without vertices, positions
// that are neither float32 nor float64, a position that is not finite after the move, a face that
// refers to a vertex which does not exist, or an output that cannot be written.
void transform_ply(const std::filesystem::path& input, const std::filesystem::path& output,
                   const FrameMove& move);

}  // namespace axial::io
