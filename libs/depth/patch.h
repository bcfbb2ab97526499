// SPDX-License-Identifier: GPL-3.0-or-later
// The matching window: 9x9 pixels, every second one, 25 texels around a reference pixel.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "depth/options.h"

namespace axial::depth {

inline constexpr int kPatchRadius = 4;
inline constexpr int kPatchStep = 2;
inline constexpr int kTexels = 25;
inline constexpr int kPaddedTexels = 32;  // four vectors of eight; the rest has weight zero

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

// The reference window gathered once per pixel and reused for every hypothesis and source view.
struct ReferencePatch {
  alignas(32) std::array<float, kPaddedTexels> weight{};     // bilateral, sums to 1
  alignas(32) std::array<float, kPaddedTexels> deviation{};  // weight * (intensity - mean)
  float mean = 0;      // weighted mean of the intensities, 0 to 255: keeps the source's sums small
  float variance = 0;  // sum of weight * (intensity - mean)^2, weights summing to 1
  float texture = 0;   // the same with weights of at most 1: what OpenMVS's threshold means
};

// Weights by intensity difference (8 bit) and texel, tabulated for one pair of sigmas.
class PatchSampler {
 public:
  explicit PatchSampler(const PatchMatchOptions& options);

  // Intensities count from 0 to 1. Precondition: the window around (x, y) lies inside the image.
  ReferencePatch gather(const cv::Mat1b& image, int x, int y) const;

 private:
  std::array<float, 256> color_weight_;
  std::array<float, kTexels> space_weight_;
};

// True if the whole window lies inside an image of this size.
inline bool window_inside(int x, int y, int width, int height) {
  return x >= kPatchRadius && y >= kPatchRadius && x < width - kPatchRadius &&
         y < height - kPatchRadius;
}

}  // namespace axial::depth
