// SPDX-License-Identifier: GPL-3.0-or-later
// The files and settings from which a survey is opened.
#pragma once

#include <filesystem>

#include "io/openmvs/scene_with_cameras.h"
#include "scene/resolution.h"

namespace axial::survey {

// Messages name the settings by files.name_of: the settings of io::SceneFiles, and "bit_depth",
// "ignore_mask_label" and "mask_folder".
struct Options {
  io::SceneFiles files;
  std::filesystem::path views_file;  // list of the images to use (views_file.h); empty: all
  // Folder with a mask for every image that is used. Empty: the mask that the scene names for the
  // image, or a mask in the image's folder (io::find_masks).
  std::filesystem::path mask_folder;
  int ignore_mask_label = -1;  // value of mask pixels to leave out; below 0: no masks are used
  bool ignore_black_border = false;  // leave out the black borders that undistortion leaves
  // The number of bits that the values of 16-bit photographs use: 8 to 16. 0: as many as the
  // largest value in all photographs needs.
  int bit_depth = 0;
  ResolutionOptions resolution;       // at which photographs are read
  bool compares_photographs = false;  // see Survey::photograph_check
  bool has_masks = true;              // false: the program does not use masks
};

// Sets what is left out by the label of a program whose label -1 means black borders, and whose
// labels below -1 mean that all pixels are used.
void use_mask_label(Options& options, int label);

}  // namespace axial::survey
