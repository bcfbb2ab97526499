// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: undistorting the images of a COLMAP model, and the masks beside them.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "base/progress.h"
#include "io/colmap.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// An image of a model that is to be undistorted.
struct DistortedImage {
  std::string name;                           // in the model
  std::filesystem::path source;               // the photograph
  std::filesystem::path mask;                 // of the photograph; empty: none
  const ColmapCamera* camera = {};            // of the photograph
  refractive::PinholeLens<double> pinhole{};  // of the undistorted image, of the same size
  bool fits_jpeg = true;  // 8 bits without transparency: a JPEG can hold the pixels
};

// The undistorted image's name, relative to its folder: ".png", and ".jpg" where a JPEG can hold
// the pixels, keep their name, everything else gets ".png" behind it, so that a.tif and a.bmp may
// lie side by side.
std::filesystem::path undistorted_name(const DistortedImage& image);

// Error that starts with `model_folder` and names both images if the undistorted ones of two of
// `images` would be one file, on file systems that do not tell a from A, too.
void require_apart(std::span<const DistortedImage> images,
                   const std::filesystem::path& model_folder);

// Writes the undistorted images below `folder`, by undistorted_name, each with its mask beside it.
// Images of one camera should follow each other: then no more maps of pixels are in memory than
// images are at work. The error of the first image in this order, if any cannot be read or written.
void undistort_images(std::span<const DistortedImage> images, const std::filesystem::path& folder,
                      const ProgressSink& progress);

}  // namespace axial::io
