// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: undistorts the images of a COLMAP model and their masks.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "base/progress.h"
#include "bytes/private/only_for_io.h"
#include "io/colmap/colmap.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// An image of a model that needs to be undistorted.
struct DistortedImage {
  std::string name;                           // of the image in the model
  std::filesystem::path source;               // the photograph
  std::filesystem::path mask;                 // of the photograph; empty: no mask
  const ColmapCamera* camera = {};            // of the photograph
  refractive::PinholeLens<double> pinhole{};  // of the undistorted image, which has the same size
  bool fits_jpeg = true;  // 8 bits without transparency: a JPEG can hold the pixels
};

// Returns the path of the undistorted image, relative to the folder of undistorted images. Names
// that end in ".png" stay. JPEG names stay if a JPEG can hold the pixels. ".png" is appended to all
// other names, so that a.tif and a.bmp get different names.
std::filesystem::path undistorted_name(const DistortedImage& image);

// Error that starts with `model_folder` and names both images if two of `images` would be
// undistorted to the same file. Upper and lower case count as equal, for file systems that ignore
// case.
void require_apart(std::span<const DistortedImage> images,
                   const std::filesystem::path& model_folder);

// Writes the undistorted images below `folder`, each with its mask beside it. undistorted_name
// gives the path of each image. The images of one camera should be consecutive in `images`: an
// undistortion map stays in memory from the first to the last image of its camera. If images cannot
// be read or written, the function throws the error of the image that comes first in `images`.
void undistort_images(std::span<const DistortedImage> images, const std::filesystem::path& folder,
                      const ProgressSink& progress);

}  // namespace axial::io
