// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS interchange scenes (.mvs): versions 0 to 7 are read, 7 is written.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::io {

// Reads a scene. Image paths in the file are relative to `working_folder`; they become absolute.
// Ports are not part of the format (see housing.h). Cameras without a resolution (normalised K) get
// it from the header of the image file.
//
// Error that names the file, the field and the value for a truncated or malformed file, fewer than
// two images, ids out of range, values that are not finite, poses that are not rotations, a focal
// length that is not positive, or a native OpenMVS project ("MVS\0").
Scene read_mvs(const std::filesystem::path& path, const std::filesystem::path& working_folder);

// How K is written. `normalised`: divided by the longer side of the image, without a resolution, as
// with OpenMVS's --normalize.
enum class MvsIntrinsics { pixels, normalised };

// Writes version 7. Image paths are relative to `working_folder` if they lie below it. Error for
// fewer than two images, no calibrated image, or values that read_mvs refuses.
void write_mvs(const std::filesystem::path& path, const Scene& scene,
               const std::filesystem::path& working_folder,
               MvsIntrinsics intrinsics = MvsIntrinsics::pixels);

}  // namespace axial::io
