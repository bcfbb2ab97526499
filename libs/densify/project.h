// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one run: the scene with its ports, neighbours, masks and working resolution, and a
// fingerprint of all data that the depth maps depend on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "axial/densify.h"
#include "io/cameras/lenses.h"
#include "scene/view_selection.h"
#include "survey/fingerprint.h"

namespace axial::densify {

using survey::View;

// The input of one run (load_project.h). In a project, Survey::views has one entry for each image
// of the scene: the camera of an image without calibration is empty (width and height 0).
struct Project : survey::Survey {
  io::SceneLenses lenses;  // lenses that are written beside the output
  // The next three have one entry for each image of the scene.
  std::vector<ViewPreparation> preparations;  // results of score_neighbours()
  // Results of filter_neighbours(); unusable image: none.
  std::vector<std::vector<ViewScore>> neighbours;
  // Source views for matching; image without a map: none.
  std::vector<std::vector<ViewScore>> sources;
  std::vector<std::size_t> references;  // images that get a depth map: indices, ascending
  std::vector<std::size_t> part;        // the references whose maps this run makes (StageJob::part)
  std::string fingerprint;              // the result of fingerprint()
};

// Returns the images of the part: consecutive elements of `images`. The numbers of images of two
// parts differ by one at most. Returns all images if StageJob::parts is 0.
std::vector<std::size_t> part_of(std::span<const std::size_t> images, const StageJob& job);

// Whether no camera of Project::views has a port or a distorted lens.
bool all_pinholes(const Project& project);

// The path of the file of an image's final depth map: depthNNNN.dmap in the working folder, where
// NNNN is the image's global id (View::id) with at least four digits. `image`: index into
// Project::views. The file need not exist.
std::filesystem::path depth_map_path(const Project& project, std::size_t image);

// Returns a fingerprint of everything that the depth maps depend on, as 32 hex digits: all numbers
// of matching and filters, cameras, poses, the contents of image files and mask files, neighbours,
// sources and sparse points. A number that a later version adds to the options changes the
// fingerprint only if it differs from its default. So existing maps stay valid. The number of
// threads and the options of fusion do not change the fingerprint. Reads the image and mask files
// of all calibrated images whose fingerprints are not in `kept`. `project`: its views must be
// selected. Throws an Error for a file that cannot be read.
std::string fingerprint(const Project& project, const MatchOptions& options,
                        const survey::KeptContents& kept = {}, const Context& context = {});

}  // namespace axial::densify
