// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one run: the scene with its ports, neighbours, masks and working resolution, and a
// fingerprint of all data that the depth maps depend on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "densify/scene_facts.h"
#include "densify/settings.h"
#include "io/cameras/lenses.h"
#include "scene/view_selection.h"
#include "survey/image_store.h"

namespace axial::densify {

using survey::View;

// The input of one run. load_scene() fills the members of the scene, and `lenses`. load_project()
// fills all members. In a project, Survey::views has one entry for each image of the scene: the
// camera of an image without calibration is empty (width and height 0).
struct Project : survey::Survey {
  io::SceneLenses lenses;  // lenses that are written beside the output
  // The next three have one entry for each image of the scene.
  std::vector<ViewPreparation> preparations;  // results of score_neighbours()
  // Results of filter_neighbours(); unusable image: none.
  std::vector<std::vector<ViewScore>> neighbours;
  // Source views for matching; image without a map: none.
  std::vector<std::vector<ViewScore>> sources;
  std::vector<std::size_t> references;  // images that get a depth map: indices, ascending
  std::vector<std::size_t> part;        // the references whose maps this run makes (Settings::part)
  std::string fingerprint;              // the result of fingerprint() (fingerprint.h)
};

// Loads the scene with its ports and lenses, and the points of Settings::point_cloud. Reads no
// image files. Throws an Error for any fault of the files that are read, and for too little memory
// to read them.
Project load_scene(const Settings& settings);

// Loads the scene, reads its images and masks, and selects views. Of image files, the headers are
// kept. The bytes of image and mask files only enter the fingerprint. `observer`, unless it is
// empty, is called before views are selected. Throws an Error for a fault of the scene or its
// housing, for files that are missing or truncated, for images whose shape differs from their
// camera's, for an id that two images have, and if no image can get a depth map.
// survey::ImageStore::check_all() finds other faults of images.
Project load_project(const Settings& settings, const SceneObserver& observer = {});

// The channels of the photographs that a run needs.
survey::Channels channels_of(const Settings& settings);

// Returns the images of the part Settings::part: consecutive elements of `images`. The numbers of
// images of two parts differ by one at most. Returns all images if Settings::parts is 0.
std::vector<std::size_t> part_of(std::span<const std::size_t> images, const Settings& settings);

// Whether no camera of Project::views has a port or a distorted lens.
bool all_pinholes(const Project& project);

// The path of the housing file: Settings::housing, or a file beside the scene if that is empty. The
// file need not exist.
std::filesystem::path housing_file(const Settings& settings);

// Writes housing, lenses and offset beside the scene Settings::output, where later programs look
// for them. If the scene has no ports, no distorted lenses or no offset, an older file with the
// name of the absent file is removed. The housing file that was read is never changed. Throws an
// Error if a file cannot be written.
void write_cameras_beside_output(const Project& project, const Settings& settings);

}  // namespace axial::densify
