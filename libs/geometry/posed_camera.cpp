// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/posed_camera.h"

#include <algorithm>

namespace axial::geometry {

std::uint64_t most_pixels(std::span<const PosedCamera> cameras) {
  std::uint64_t pixels = 0;
  for (const auto& [camera, pose] : cameras)
    pixels = std::max(pixels, static_cast<std::uint64_t>(camera.width) *
                                  static_cast<std::uint64_t>(camera.height));
  return pixels;
}

std::vector<PosedCamera> posed_cameras(const Scene& scene) {
  std::vector<PosedCamera> cameras;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) cameras.push_back({image.camera, image.pose});
  return cameras;
}

}  // namespace axial::geometry
