// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost loop: zero-mean normalised cross-correlation of a reference patch with a source
// image sampled bilinearly at 25 positions. Knows nothing of cameras.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "depth/patch.h"

namespace axial::depth {

// An 8-bit image prepared for bilinear sampling: one word per pixel holds its 2x2 neighbourhood
// (right, below, below right in bytes 1, 2, 3), so that a texel costs one load.
class QuadImage {
 public:
  QuadImage() = default;
  explicit QuadImage(const cv::Mat1b& image);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::uint32_t* words() const { return words_.data(); }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint32_t> words_;  // row-major, width * height
};

// Where the texels of a patch fall in the source image, padded with repeats of the centre.
struct TexelPositions {
  alignas(32) std::array<float, kPaddedTexels> x;
  alignas(32) std::array<float, kPaddedTexels> y;
};

// Correlation in [-1, 1] or kNoCorrelation. All implementations add in the same order without fused
// multiplications and so give the same bytes.
using ZnccFunction = float (*)(const ReferencePatch&, const QuadImage&, const TexelPositions&);

// The reference implementation, in plain C++.
float zncc_scalar(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at);

// The fastest implementation this processor can run.
ZnccFunction fastest_zncc();

namespace detail {
float zncc_avx2(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at);
}

}  // namespace axial::depth
