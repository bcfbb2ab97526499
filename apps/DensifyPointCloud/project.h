// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one run: the scene with its ports, neighbours, masks and working resolution, and the
// fingerprint of everything that the depth maps depend on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/housing.h"
#include "io/image.h"
#include "io/lenses.h"
#include "options.h"
#include "scene/local_frame.h"
#include "scene/scene.h"
#include "scene/view_selection.h"

namespace densify {

// One image of the scene at the resolution that it is worked on at; ImageStore has the pixels.
// Images without calibration have an empty camera.
struct View {
  std::uint32_t id = 0;  // global id
  axial::CameraModel camera;
  axial::Pose pose;
  axial::io::ImageHeader file;
  std::filesystem::path mask;  // empty: none

  // Whether WorkImage::mask may be there.
  bool masked() const { return !mask.empty() || file.alpha; }
};

struct Project {
  axial::Scene scene;                         // in `frame`, with ports and neighbour scores
  axial::LocalFrame frame;                    // that the scene's coordinates count from
  std::optional<axial::io::Housing> housing;  // that the ports come from; in the world
  axial::io::Lenses lenses;                   // to be written beside the output
  std::vector<axial::ViewPreparation> preparations;
  std::vector<View> views;                                // one an image of the scene
  std::vector<std::vector<axial::ViewScore>> neighbours;  // filtered
  std::vector<std::vector<axial::ViewScore>> sources;     // chosen for matching
  std::vector<std::size_t> references;                    // images that get a depth map
  int bit_depth = 16;                                     // that the values of 16-bit images use
  std::string fingerprint;
};

// The scene with its ports and lenses, and the points of -p: all that needs no image files. Error
// for anything wrong with these files.
Project load_scene(const Options& options);

// Reads the scene and the bytes of its images and masks, but keeps no pixels. Error for anything
// wrong with the scene or its housing, for files that are missing or cut, and for images of another
// shape than their camera; ImageStore::check_all finds the rest.
Project load_project(const Options& options);

// Whether every calibrated image is a pinhole's.
bool all_pinholes(const Project& project);

// Where the housing is read from, if there is one.
std::filesystem::path housing_file(const Options& options);

// Leaves the housing, the lenses and the offset beside the output scene, where every later program
// finds them. A scene without ports, distorted lenses or an offset gets none, and an older one of
// the same name goes; the housing that --housing names stays as it is.
void write_cameras_beside_output(const Project& project, const Options& options);

}  // namespace densify
