// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a COLMAP model and its images to a scene.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

struct ColmapImport {
  std::filesystem::path model_folder;        // for messages
  std::filesystem::path image_folder;        // image names are relative to it
  std::filesystem::path undistorted_folder;  // where undistorted images go; made when needed
  bool undistort = true;  // false: keep the lenses whose distortion the matcher can model
};

// Returns the scene of `model` with its images in the model's order. Images of pinhole cameras are
// used as they are. Other cameras either keep their lens (see `undistort` and lens_distortion), or
// are replaced by a pinhole (pinhole_inside). In the second case their images and masks are
// resampled into `undistorted_folder`. JPEG files with 8 bits and no transparency stay JPEG; other
// files become PNG.
//
// An image id is COLMAP's id minus one, or COLMAP's id if the ids start at 0. The views of a sparse
// point are sorted by image and have confidence 0. An image that occurs twice in a track counts
// once, and a line of the log states how many such observations there are.
//
// Memory: undistortion maps exist only for images in work, at most one image for each thread.
//
// Error that names the file, the field and the value, before any file is written, if the model has
// fewer than two images, an image file is missing or has another size than its camera, two images
// would be undistorted to the same file, or an undistorted image would replace a photograph.
Scene import_colmap_scene(const ColmapModel& model, const ColmapImport& import,
                          const ProgressSink& undistorting = {},
                          const ProgressSink& preparing_cameras = {});

// Returns the ports of `cameras`, as files of COLMAP-Underwater contain them. The port of camera 1
// is named "camera_1", and so on. The housing has no ports if no camera has one.
Housing housing_of(std::span<const ColmapCamera> cameras);

// Reads a housing file and resolves its entries for the images of `model` (for_images).
Housing read_housing(const std::filesystem::path& path, const ColmapModel& model);

// Returns `housing` with one entry for every image whose port is not the default, and without
// entries by camera id. attach_ports, and programs that no longer know COLMAP's camera ids, need
// this form. `scene` must have been imported from `model`. Error if an image would get the port of
// another image because the end of its path is the name of that image.
Housing housing_by_image(const Housing& housing, const ColmapModel& model, const Scene& scene,
                         const ColmapImport& import);

// Returns the entries of `housing` that match no image or camera of the model, for example
// "images.a.jpg" and "cameras.2".
std::vector<std::string> unused_entries(const Housing& housing, const ColmapModel& model);

}  // namespace axial::io
