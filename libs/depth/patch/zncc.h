// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost loop of matching: zero-mean normalised cross-correlation (ZNCC) of a reference
// patch with a source image that is sampled bilinearly at 25 positions. Does not depend on cameras.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "depth/patch/patch.h"

namespace axial::depth {

// An 8-bit image prepared for bilinear sampling. One 32-bit word per pixel holds the grey levels of
// the pixel and of its right, lower and lower right neighbours in bytes 0 to 3, so that a texel
// needs one load. In the last column and row, the border pixels are repeated.
class QuadImage {
 public:
  QuadImage() = default;  // an image without pixels
  // Precondition: `image` is not empty.
  explicit QuadImage(const cv::Mat1b& image);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::uint32_t* words() const { return words_.data(); }  // row-major, width() * height()

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint32_t> words_;  // row-major, width * height
};

// Positions of the texels of a patch in the source image [px]. The entries after the last texel
// repeat the centre.
struct TexelPositions {
  alignas(32) std::array<float, kPaddedTexels> x;
  alignas(32) std::array<float, kPaddedTexels> y;
};

// A function that returns the correlation in [-1, 1] of the reference patch with the source image
// at the texel positions, or kNoCorrelation, whose comment lists the cases. Positions may lie
// outside the image. All implementations add in the same order and use no fused multiply-add. So
// their results are bit-identical.
using ZnccFunction = float (*)(const ReferencePatch&, const QuadImage&, const TexelPositions&);

// The reference implementation, in plain C++.
float zncc_scalar(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at);

// The fastest implementation that this processor supports.
ZnccFunction fastest_zncc();

namespace detail {
// Returns the correlation of a patch that lies partly outside the source image. All sums, including
// those over the reference patch, take only the texels inside the source image.
float zncc_of_part(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at);
// The implementation with AVX2, which the processor must support.
float zncc_avx2(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at);
}  // namespace detail

}  // namespace axial::depth
