// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/zncc.h"

#include <cmath>

#include "depth/zncc_reduce.h"

namespace axial::depth {

QuadImage::QuadImage(const cv::Mat1b& image)
    : width_(image.cols),
      height_(image.rows),
      words_(static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows)) {
  const auto word = [](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return a | b << 8 | c << 16 | d << 24;
  };
  std::uint32_t* words = words_.data();
  for (int y = 0; y < height_; ++y, words += width_) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1 < height_ ? y + 1 : y);
    const int last = width_ - 1;  // apart, so that the others go into vectors
    for (int x = 0; x < last; ++x) words[x] = word(row[x], row[x + 1], below[x], below[x + 1]);
    words[last] = word(row[last], row[last], below[last], below[last]);
  }
}

float zncc_scalar(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at) {
  const auto max_x = static_cast<float>(source.width() - 2);
  const auto max_y = static_cast<float>(source.height() - 2);
  ZnccSums sums;
  for (std::size_t k = 0; k < kPaddedTexels; ++k) {
    const float x = at.x[k];
    const float y = at.y[k];
    if (!(x >= 1.0f && y >= 1.0f && x <= max_x && y <= max_y)) return kNoCorrelation;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    const std::uint32_t word =
        source.words()[static_cast<std::size_t>(row) * static_cast<std::size_t>(source.width()) +
                       static_cast<std::size_t>(column)];
    const auto a = static_cast<float>(word & 0xFFu);
    const auto b = static_cast<float>(word >> 8 & 0xFFu);
    const auto c = static_cast<float>(word >> 16 & 0xFFu);
    const auto d = static_cast<float>(word >> 24);
    const float top = a + fx * (b - a);
    const float bottom = c + fx * (d - c);
    const float value = top + fy * (bottom - top) - patch.mean;
    const float weighted = patch.weight[k] * value;
    const std::size_t lane = k % 8;
    sums.mean[lane] += weighted;
    sums.square[lane] += weighted * value;
    sums.cross[lane] += patch.deviation[k] * value;
  }
  return correlation(sums, patch.variance);
}

ZnccFunction fastest_zncc() {
  return __builtin_cpu_supports("avx2") ? detail::zncc_avx2 : zncc_scalar;
}

}  // namespace axial::depth
