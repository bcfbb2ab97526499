// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/geometry.h"

namespace axial::geometry {

// True if the pixel is at least `border` pixels inside the centres of the outermost pixels. -0.5:
// the rectangle of the image with the whole area of these pixels.
inline bool is_in_image(const CameraModel& camera, const Eigen::Vector2d& pixel, double border) {
  return pixel.minCoeff() >= border && pixel.x() <= camera.width - 1 - border &&
         pixel.y() <= camera.height - 1 - border;
}

// The number of pixels of the largest image; 0 without cameras.
std::uint64_t most_pixels(std::span<const PosedCamera> cameras);

// The cameras of the calibrated images, in the order of the images.
std::vector<PosedCamera> posed_cameras(const Scene& scene);

}  // namespace axial::geometry
