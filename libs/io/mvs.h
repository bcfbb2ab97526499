// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS interchange scenes (.mvs): versions 0 to 7 are read, 7 is written.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::io {

// Reads a scene. `working_folder`: base of the relative image paths in it (they become absolute).
// Ports are not part of the format: see housing.h. Error that names file, field and value for a
// truncated or malformed file, ids out of range, NaN or non-rotation poses, zero focal length, a
// native ("MVS\0") project. Cameras without a resolution (normalised K) take it from the header of
// the image file.
Scene read_mvs(const std::filesystem::path& path, const std::filesystem::path& working_folder);

// `normalised`: K divided by the longer side, and no resolution, as OpenMVS's --normalize.
enum class MvsIntrinsics { pixels, normalised };

// Writes version 7; image paths relative to `working_folder` where they lie below it.
void write_mvs(const std::filesystem::path& path, const Scene& scene,
               const std::filesystem::path& working_folder,
               MvsIntrinsics intrinsics = MvsIntrinsics::pixels);

}  // namespace axial::io
