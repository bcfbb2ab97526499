// SPDX-License-Identifier: GPL-3.0-or-later
// Gathers the matching window around a reference pixel.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "depth/options.h"
#include "depth/reference_patch.h"

namespace axial::depth {

// Texel offsets from the window's centre, row by row. Padding repeats the centre.
struct TexelOffsets {
  alignas(32) std::array<float, kPaddedTexels> x{};
  alignas(32) std::array<float, kPaddedTexels> y{};
};

constexpr TexelOffsets make_texel_offsets() {
  TexelOffsets offsets;
  int k = 0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; dy += kPatchStep)
    for (int dx = -kPatchRadius; dx <= kPatchRadius; dx += kPatchStep, ++k) {
      offsets.x[static_cast<std::size_t>(k)] = static_cast<float>(dx);
      offsets.y[static_cast<std::size_t>(k)] = static_cast<float>(dy);
    }
  return offsets;
}

inline constexpr TexelOffsets kTexelOffsets = make_texel_offsets();

// Weights by intensity difference (8 bit) and texel, tabulated for one pair of sigmas.
class PatchSampler {
 public:
  explicit PatchSampler(const PatchMatchOptions& options);

  // Deviations count intensities from 0 to 1. Precondition: the window around (x, y) lies inside
  // the image.
  void gather(const cv::Mat1b& image, int x, int y, ReferencePatch& patch) const;

 private:
  std::array<float, 511> color_weight_;  // of differences from -255 on
  std::array<float, kTexels> space_weight_;
};

// True if the whole window lies inside an image of this size.
inline bool window_inside(int x, int y, int width, int height) {
  return x >= kPatchRadius && y >= kPatchRadius && x < width - kPatchRadius &&
         y < height - kPatchRadius;
}

}  // namespace axial::depth
