// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one run: the scene with its ports, neighbours, masks and working resolution, and the
// fingerprint of everything that the depth maps depend on.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "depth/patch_match.h"
#include "io/housing.h"
#include "options.h"
#include "scene/scene.h"
#include "scene/view_selection.h"

namespace densify {

struct Project {
  axial::Scene scene;                         // as read, with ports and neighbour scores
  std::optional<axial::io::Housing> housing;  // that the ports come from
  std::vector<axial::ViewPreparation> preparations;
  std::vector<axial::depth::MatchImage> views;            // one an image of the scene
  std::vector<std::vector<axial::ViewScore>> neighbours;  // filtered
  std::vector<std::vector<axial::ViewScore>> sources;     // chosen for matching
  std::vector<cv::Mat1b> masks;                           // empty, or non-zero: match
  std::vector<std::size_t> references;                    // images that get a depth map
  std::string fingerprint;
};

// Reads everything but keeps no colours. Error for anything wrong with the scene, its housing, its
// images or masks.
Project load_project(const Options& options);

// Leaves the housing beside the output scene, where every later program finds it. A scene without
// ports gets none, and an older one of the same name goes.
void write_housing_beside_output(const Project& project, const Options& options);

// The colours of an image at its working resolution, B G R.
cv::Mat3b load_color(const Project& project, std::size_t image);

}  // namespace densify
