// SPDX-License-Identifier: GPL-3.0-or-later
// From a COLMAP model and its images to a scene.
#pragma once

#include <filesystem>
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
};

// The scene of `model`, images in the model's order, at least two. Every image file must exist and
// have its camera's size. Cameras that are no pinholes are replaced by one (pinhole_inside) and
// their images resampled into `undistorted_folder`: JPEGs stay JPEGs, everything else becomes PNG.
// Image ids are COLMAP's less one, or COLMAP's own if they start at 0. Views of sparse points are
// sorted by image and have no confidence. Error that names file, field and value.
Scene import_colmap_scene(const ColmapModel& model, const ColmapImport& import,
                          const ProgressSink& progress = {});

// `housing` with one entry an image whose port is not the default, and none by camera id: what
// attach_ports and programs that no longer know COLMAP's ids need. `scene` is the one imported
// from `model`. Entries for images or cameras that are not in the model are dropped and come back
// in `unused`.
Housing housing_by_image(const Housing& housing, const ColmapModel& model, const Scene& scene,
                         const ColmapImport& import, std::vector<std::string>* unused = nullptr);

}  // namespace axial::io
