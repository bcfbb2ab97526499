// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs that give the mesh its colours, with their masks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/images/image.h"
#include "settings.h"
#include "texture/views.h"

namespace axial::apps {

class Photographs {
 public:
  // Finds the used images and their masks, and reads the headers of the files. The used images are
  // all calibrated images of `scene`, or only the images that Settings::views_file names. Error for
  // a missing image, an image of another shape than its camera's, a missing mask in
  // Settings::mask_folder, and a line of the views file that names no image.
  Photographs(const Scene& scene, const Settings& settings);

  const std::vector<texture::View>& views() const { return views_; }

  // The files that are read: photographs and masks.
  std::vector<std::filesystem::path> files() const;

  // The largest memory [bytes] of load() for a view, with the result.
  std::uint64_t bytes_to_load() const;

  // The photograph of a view. May be called concurrently. Error if a file cannot be read.
  texture::ViewImage load(std::size_t view) const;

 private:
  void find_masks(const Scene& scene, const Settings& settings);

  MaskChoice choice_;
  int label_;
  int bit_depth_ = 8;
  std::vector<std::size_t> images_;  // index into Scene::images, one per view
  std::vector<std::filesystem::path> files_, masks_;
  std::vector<io::ImageHeader> headers_;
  std::vector<texture::View> views_;
};

}  // namespace axial::apps
