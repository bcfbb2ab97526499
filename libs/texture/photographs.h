// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs of a scene as programs read them to texture a mesh, with their masks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/setting_names.h"
#include "belong/photograph_check.h"
#include "io/images/image.h"
#include "scene/resolution.h"
#include "scene/scene.h"
#include "texture/views.h"

namespace axial::texture {

// How pixels are found that must not be used.
enum class MaskChoice {
  label,         // pixels whose label in the image's mask is PhotographOptions::mask_label
  black_border,  // pixels of the black borders that undistortion leaves
  none           // all pixels are used
};

struct PhotographOptions {
  std::filesystem::path views_file;   // list of the images to use; empty: all
  std::filesystem::path mask_folder;  // empty: masks of the scene, or beside the images
  MaskChoice masks = MaskChoice::black_border;
  int mask_label = 0;
  int bit_depth = 0;  // of 16-bit photographs; 0: see common_bit_depth() (io/images/bit_depth.h)
  ResolutionOptions resolution{0, 640, 1 << 20};
  // Errors name the fields mask_folder and bit_depth by name_of("mask_folder") and so on.
  SettingNames name_of = own_name;
};

class Photographs {
 public:
  // Finds the used images and their masks, and reads the headers of the files. The used images are
  // all calibrated images of `scene`, or only the images that `views_file` names. `scene_file`: the
  // file of the scene, for messages. Error for a missing image, an image of another shape than its
  // camera's, a missing mask in `mask_folder`, a line of the views file that names no image, and if
  // there is no image to use. Sizes are checked as by io::check_photograph_sizes().
  Photographs(const Scene& scene, const std::filesystem::path& scene_file,
              const PhotographOptions& options);

  const std::vector<View>& views() const { return views_; }

  // The files that are read: photographs and masks.
  std::vector<std::filesystem::path> files() const;

  // The largest memory [bytes] of load() for a view, with the result.
  std::uint64_t bytes_to_load() const;

  // The photograph of a view. May be called concurrently. Error if a file cannot be read.
  ViewImage load(std::size_t view) const;

  // Reports photographs that do not belong to the scene, of those that load() has returned
  // (belong::PhotographCheck::report()). Call it before outputs are written.
  void check() const { check_->report(); }

 private:
  void find_masks(const Scene& scene, const PhotographOptions& options);

  MaskChoice choice_;
  int label_;
  int bit_depth_ = 8;
  std::vector<std::size_t> images_;  // index into Scene::images, one per view
  std::vector<std::filesystem::path> files_, masks_;
  std::vector<io::ImageHeader> headers_;
  std::vector<View> views_;
  std::unique_ptr<belong::PhotographCheck> check_;  // load() gives it the photographs
};

}  // namespace axial::texture
