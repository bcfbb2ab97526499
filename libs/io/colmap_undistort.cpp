// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap_undistort.h"

#include <algorithm>

#include "base/error.h"
#include "base/file_extension.h"
#include "io/colmap_lens.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

}  // namespace

fs::path undistorted_name(const DistortedImage& image) {
  fs::path undistorted = fs::path(image.name).lexically_normal();
  const std::string extension = lower_extension(undistorted);
  const bool jpeg = image.fits_jpeg && (extension == ".jpg" || extension == ".jpeg");
  if (!jpeg && undistorted.extension() != ".png") undistorted += ".png";
  return undistorted;
}

void require_apart(std::span<const DistortedImage> images, const fs::path& model_folder) {
  std::map<std::string, const std::string*> taken;
  for (const DistortedImage& image : images) {
    const std::string undistorted = undistorted_name(image).generic_string();
    const auto [other, added] = taken.try_emplace(lower(undistorted), &image.name);
    if (!added)
      fail("{}: the images {} and {} would both be undistorted to {}: rename one of them",
           model_folder.string(), *other->second, image.name, undistorted);
  }
}

void UndistortionMaps::expect(const ColmapCamera& camera,
                              const refractive::PinholeLens<double>& pinhole) {
  Entry& entry = entries_[camera.id];
  entry.camera = &camera;
  entry.pinhole = pinhole;
  ++entry.images_left;
}

cv::Mat2f UndistortionMaps::take(std::uint32_t id) {
  Entry& entry = entries_.at(id);
  const std::scoped_lock lock(entry.mutex);
  if (entry.map.empty()) entry.map = undistortion_map(*entry.camera, entry.pinhole);
  cv::Mat2f map = entry.map;
  if (--entry.images_left == 0) entry.map.release();
  return map;
}

}  // namespace axial::io
