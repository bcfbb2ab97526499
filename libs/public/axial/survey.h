// SPDX-License-Identifier: GPL-3.0-or-later
// From what a survey is opened: files and settings, or data in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "axial/base.h"
#include "axial/io.h"
#include "axial/scene.h"
#include "axial/scene_options.h"

namespace axial::survey {

// A survey in memory.
struct MemorySurvey {
  // In the coordinates of the world. Each calibrated image has its camera with lens and port, its
  // pose, and a path that no other image has, for messages and for written scenes. The path need
  // not be that of a file. Ids are kNoId or differ. mask_path, port_name, the depths and the
  // neighbours of an image are not used.
  Scene scene;
  // Returns the photograph of an image: CV_8UC3, of the size of its camera. Called by several
  // threads at the same time, several times for each image. It must return the same pixels each
  // time.
  std::function<io::Photograph(std::size_t image)> read;
  bool has_masks = false;  // whether `read` may return photographs with Photograph::opaque
};

// Throws an Error that names the field and its value, as in "images[3].camera.width 0: ...", for
// - an empty `read`, or a scene without a calibrated image,
// - a calibrated image with an empty path or the path of another image, with a size or a focal
//   length that is not above 0, numbers that are not finite, or a pose that is not a rotation,
// - a port with values that are not possible (those that a housing file may not have),
// - a sparse point that is not finite or that an image sees that does not exist.
void check(const MemorySurvey& survey);

// Messages name the settings of io::SceneFiles, and "bit_depth", "color_folder",
// "ignore_mask_label" and "mask_folder".
struct Options {
  io::SceneFiles files;
  std::shared_ptr<const MemorySurvey> memory_survey;  // not null: instead of files.scene
  std::filesystem::path views_file;  // list of the images to use, one path a line; empty: all
  // Folder with a mask for every image that is used. Empty: the mask that the scene names for the
  // image, or a mask in the image's folder.
  std::filesystem::path mask_folder;
  int ignore_mask_label = -1;  // value of mask pixels to leave out; below 0: no masks are used
  bool ignore_black_border = false;  // leave out the black borders that undistortion leaves
  // Folder with the colours of every image that is used: pictures of the size of the photographs,
  // as RestoreColors writes them. Empty: the photographs have the colours. Transparency and black
  // borders are always those of the photographs.
  std::filesystem::path color_folder;
  bool match_colors = false;  // grey levels, for matching, come from color_folder, which is set
  // The number of bits that the values of 16-bit photographs use: 8 to 16. 0: as many as the
  // largest value in all photographs needs.
  int bit_depth = 0;
  ResolutionOptions resolution;  // at which photographs are read
  // Whether photographs are compared with each other, to report those that do not belong to the
  // scene.
  bool compares_photographs = false;
  bool has_masks = true;  // false: the program does not use masks
};

}  // namespace axial::survey
