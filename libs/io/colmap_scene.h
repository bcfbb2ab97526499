// SPDX-License-Identifier: GPL-3.0-or-later
// From a COLMAP model and its images to a scene.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "io/colmap.h"
#include "io/housing.h"
#include "scene/scene.h"

namespace axial::io {

struct ColmapImport {
  std::filesystem::path model_folder;        // for messages
  std::filesystem::path image_folder;        // image names are relative to it
  std::filesystem::path undistorted_folder;  // where undistorted images go; made when needed
  bool undistort = true;  // false: lenses stay distorted where the matcher follows their model
};

// The scene of `model`, images in the model's order, at least two. Every image file must exist and
// have its camera's size. Cameras that are no pinholes keep their lens (lens_distortion), or are
// replaced by a pinhole (pinhole_inside) and their images resampled into `undistorted_folder`, with
// the masks beside them: JPEGs stay JPEGs, everything else becomes PNG. No two images may be
// undistorted to one file, or to a photograph. Only the images at work, one a thread, have their
// undistortion maps in memory. Image ids are COLMAP's less one, or COLMAP's own if they start at 0.
// Views of sparse points are sorted by image, each image once (a line counts the others), and have
// no confidence. Error that names file, field and value, before anything is written.
Scene import_colmap_scene(const ColmapModel& model, const ColmapImport& import,
                          const ProgressSink& undistorting = {},
                          const ProgressSink& preparing_cameras = {});

// The ports that cameras carry, as files of COLMAP-Underwater do: "camera_1" for camera 1, and so
// on. No port if none does.
Housing housing_of(std::span<const ColmapCamera> cameras);

// The housing file for the images of a model (for_images).
Housing read_housing(const std::filesystem::path& path, const ColmapModel& model);

// `housing` with an entry for every image that would not get its port by the default, and none by
// camera id: what attach_ports and programs that no longer know COLMAP's ids need. `scene` is the
// one imported from `model`. Error if an image's path ends in the name of another one with another
// port.
Housing housing_by_image(const Housing& housing, const ColmapModel& model, const Scene& scene,
                         const ColmapImport& import);

// The entries that no image of the model goes by, as "images.a.jpg" and "cameras.2".
std::vector<std::string> unused_entries(const Housing& housing, const ColmapModel& model);

}  // namespace axial::io
