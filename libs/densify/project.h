// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one run: the scene with its ports, neighbours, masks and working resolution, and a
// fingerprint of all data that the depth maps depend on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "densify/scene_facts.h"
#include "densify/settings.h"
#include "io/cameras/lenses.h"
#include "io/images/image.h"
#include "io/openmvs/scene_with_cameras.h"
#include "scene/view_selection.h"

namespace axial::densify {

// One image of the scene at its working resolution. Its pixels are in ImageStore (image_store.h).
// Images without calibration have an empty camera.
struct View {
  std::uint32_t id = 0;  // global id
  CameraModel camera;
  Pose pose;
  io::ImageHeader file;
  std::filesystem::path mask;  // empty: none

  // Whether WorkImage::mask may be non-empty.
  bool masked() const { return !mask.empty() || file.alpha; }
};

struct Project : io::SceneWithCameras {  // the scene also has neighbour scores
  io::SceneLenses lenses;                // lenses that are written beside the output
  // The next four have one entry for each image of the scene.
  std::vector<ViewPreparation> preparations;
  std::vector<View> views;
  std::vector<std::vector<ViewScore>> neighbours;  // results of filter_neighbours()
  std::vector<std::vector<ViewScore>> sources;     // source views for matching
  std::vector<std::size_t> references;             // images that get a depth map
  int bit_depth = 16;  // number of bits that the values of 16-bit images use
  std::string fingerprint;
};

// Loads the scene with its ports and lenses, and the points of Settings::point_cloud. Reads no
// image files. Error for any fault of the files that are read.
Project load_scene(const Settings& settings);

// Loads the scene and reads the headers of its images and masks. Selects no views. Errors as for
// load_project.
Project load_scene_and_headers(const Settings& settings);

// Loads the scene, reads its images and masks, and selects views. Of image and mask files, the
// headers are kept, and the bytes only enter the fingerprint. `observer` is called before views are
// selected. Throws an Error for a fault of the scene or its housing, for files that are missing or
// truncated, and for images whose shape differs from their camera's. ImageStore::check_all finds
// other faults of images.
Project load_project(const Settings& settings, const SceneObserver& observer = {});

// Whether no camera has a port or a distorted lens.
bool all_pinholes(const Project& project);

// The path of the housing file. The file need not exist.
std::filesystem::path housing_file(const Settings& settings);

// Writes housing, lenses and offset beside the output scene, where later programs look for them.
// If the scene has no ports, no distorted lenses or no offset, an older file with the name of the
// absent file is removed. The housing file that was read is never changed.
void write_cameras_beside_output(const Project& project, const Settings& settings);

}  // namespace axial::densify
