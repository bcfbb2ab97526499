// SPDX-License-Identifier: GPL-3.0-or-later
// Whether photographs have the sizes that their cameras need.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>

#include "axial/base.h"

namespace axial::io {

// A photograph and the size that the scene records for its camera.
struct PhotographSize {
  std::filesystem::path file;
  cv::Size stored;  // of the photograph [px]
  cv::Size camera;  // [px]
};

// Checks photographs of any resolution: CameraModel::resized() gives a camera for each of them.
//   - Error for the first photograph whose shape differs from its camera's (same_shape() in
//     scene/resolution.h).
//   - Error for the first photograph whose longer side is less than an eighth of the camera's: it
//     is a preview, or no photograph of this scene.
//   - One warning through `context` if photographs have less than 0.9 of the camera's longer side.
//     It states how many they are and names the first one. Such photographs are used, with less
//     detail.
void check_photograph_sizes(std::span<const PhotographSize> photographs, const Context& context);

}  // namespace axial::io
