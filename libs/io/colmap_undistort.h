// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: undistorting the images of a COLMAP model: their names, and the maps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "io/colmap.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// An image of a model that is to be undistorted.
struct DistortedImage {
  std::string name;       // in the model
  bool fits_jpeg = true;  // 8 bits without transparency: a JPEG can hold its pixels
};

// The undistorted image's name, relative to its folder: ".png", and ".jpg" where a JPEG can hold
// the pixels, keep their name, everything else gets ".png" behind it, so that a.tif and a.bmp may
// lie side by side.
std::filesystem::path undistorted_name(const DistortedImage& image);

// Error that starts with `model_folder` and names both images if the undistorted ones of two of
// `images` would be one file, on file systems that do not tell a from A, too.
void require_apart(std::span<const DistortedImage> images,
                   const std::filesystem::path& model_folder);

// The maps of cv::remap that undistort a model's images, each in memory from the first of its
// camera's images to the last. Images should be worked on camera by camera: then no more maps are
// alive than images are at work.
class UndistortionMaps {
 public:
  // One more image of `camera`, which becomes `pinhole`. `camera` must stay where it is.
  void expect(const ColmapCamera& camera, const refractive::PinholeLens<double>& pinhole);

  // The map for one of the expected images of camera `id`. From any thread.
  cv::Mat2f take(std::uint32_t id);

 private:
  struct Entry {
    const ColmapCamera* camera = nullptr;
    refractive::PinholeLens<double> pinhole{};
    std::size_t images_left = 0;
    std::mutex mutex{};
    cv::Mat2f map{};
  };
  std::map<std::uint32_t, Entry> entries_;
};

}  // namespace axial::io
