// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "axial/scene_images.h"

namespace axial {

// The memory [bytes] of a map of `pixels` pixels: of the depths alone, and of depths, normals and
// confidences together.
constexpr std::uint64_t bytes_of_depths(std::uint64_t pixels) {
  return 4 * pixels;
}
constexpr std::uint64_t bytes_of_map(std::uint64_t pixels) {
  return (4 + 12 + 4) * pixels;
}

}  // namespace axial
