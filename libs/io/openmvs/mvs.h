// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS interchange scenes (.mvs): versions 0 to 7 are read, 7 is written.
#pragma once

#include <filesystem>

#include "axial/base.h"
#include "scene/scene.h"

namespace axial::io {

// Reads a scene. All relative paths of images in the file start at one folder: at `working_folder`
// (empty: the current folder), at the folder of the scene, or at one of the three folders above it.
// It is the first of these folders that has all images, or else the first that has the most. A line
// of `context` states a folder that is not the working folder. Paths of masks start at a folder
// that is found in the same way. Warns through `context` if the working folder or the folder of the
// scene has another file of the same name. All paths in the result are absolute. Ports are not part
// of the format (see housing.h). If a camera is stored without a resolution (normalised K), the
// resolution is read from the header of the image file, and a warning states the principal point
// that is assumed.
//
// Error that names the file, the field and the value for a truncated or malformed file, a file
// without platforms, fewer than two images, ids out of range or repeated, values that are not
// finite, rotation matrices that are not rotations, a focal length that is not positive, a skew, or
// a native OpenMVS project ("MVS\0").
Scene read_mvs(const std::filesystem::path& path, const std::filesystem::path& working_folder,
               const Context& context = {});

// How write_mvs() stores the calibration matrix K. `pixels`: in pixels, with the resolution of the
// image. `normalised`: divided by the longer side of the image, without a resolution, as with
// OpenMVS's --normalize.
enum class MvsIntrinsics { pixels, normalised };

// Writes a scene in version 7 of the format and replaces an existing file. Ports and lens
// distortions are left out. Paths of images and masks below `working_folder` are stored relative to
// it, other paths are stored whole. Error for fewer than two images, no calibrated image, sparse
// points that read_mvs() refuses, a file that cannot be written, or, with normalised intrinsics, a
// principal point that readers of the file would place elsewhere.
void write_mvs(const std::filesystem::path& path, const Scene& scene,
               const std::filesystem::path& working_folder,
               MvsIntrinsics intrinsics = MvsIntrinsics::pixels);

}  // namespace axial::io
