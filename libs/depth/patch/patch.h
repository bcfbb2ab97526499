// SPDX-License-Identifier: GPL-3.0-or-later
// Gathers the matching window around a reference pixel.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "axial/depth.h"
#include "depth/patch/reference_patch.h"

namespace axial::depth {

// Offsets of the texels from the window's centre [px], row by row. The entries after the last texel
// are 0.
struct TexelOffsets {
  alignas(32) std::array<float, kPaddedTexels> x{};
  alignas(32) std::array<float, kPaddedTexels> y{};
};

// Computes kTexelOffsets.
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

// Gathers windows with bilateral weights. The factors of the weights are tabulated: one by the
// difference of 8-bit intensities, one by texel. Of the options, only sigma_color and sigma_space
// are used.
class PatchSampler {
 public:
  explicit PatchSampler(const PatchMatchOptions& options);

  // Sets `patch` to the window around pixel (x, y). Texels outside the image have weight 0.
  // Precondition: (x, y) lies inside the image.
  void gather(const cv::Mat1b& image, int x, int y, ReferencePatch& patch) const;

 private:
  // kWhole: the whole window lies inside the image, so texels are not tested.
  template <bool kWhole>
  void gather_window(const cv::Mat1b& image, int x, int y, ReferencePatch& patch) const;

  std::array<float, 511> color_weight_;  // index: difference + 255
  std::array<float, kTexels> space_weight_;
};

// True if the whole window around pixel (x, y) lies inside an image of width x height pixels.
inline bool window_inside(int x, int y, int width, int height) {
  return x >= kPatchRadius && y >= kPatchRadius && x < width - kPatchRadius &&
         y < height - kPatchRadius;
}

}  // namespace axial::depth
