// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch/zncc.h"

#include <algorithm>
#include <cmath>

#include "depth/patch/part_sums.h"
#include "depth/patch/zncc_reduce.h"

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
    const auto* row = image.ptr<std::uint8_t>(y);
    const auto* below = image.ptr<std::uint8_t>(y + 1 < height_ ? y + 1 : y);
    const int last = width_ - 1;  // separate, so that the loop can be vectorised
    for (int x = 0; x < last; ++x) words[x] = word(row[x], row[x + 1], below[x], below[x + 1]);
    words[last] = word(row[last], row[last], below[last], below[last]);
  }
}

namespace {

// The grey level at (x, y). Precondition: 0 <= x < width - 1, 0 <= y < height - 1.
float bilinear(const QuadImage& source, float x, float y) {
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
  return top + fy * (bottom - top);
}

// How much a texel at (x, y) counts, 0 to 1; 0 if x or y is not a number.
float share_inside(const QuadImage& source, float x, float y) {
  const auto right = static_cast<float>(source.width() - 1);
  const auto bottom = static_cast<float>(source.height() - 1);
  if (!(x > 0 && y > 0 && x < right && y < bottom)) return 0;
  return std::min({x, y, right - x, bottom - y, 1.0f});
}

}  // namespace

namespace detail {

float zncc_of_part(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at) {
  if (!(share_inside(source, at.x[kCentreTexel], at.y[kCentreTexel]) > 0)) return kNoCorrelation;
  PartSums<float> sums;
  for (std::size_t k = 0; k < kTexels; ++k) {
    const float share = share_inside(source, at.x[k], at.y[k]);
    if (!(share > 0)) continue;
    const float value = bilinear(source, at.x[k], at.y[k]) - patch.mean;
    const float weight = share * patch.weight[k], deviation = share * patch.deviation[k];
    sums.weights += weight;
    sums.reference += deviation;
    sums.reference_square += share * reference_square(patch, k);
    sums.mean += weight * value;
    sums.square += weight * value * value;
    sums.cross += deviation * value;
  }
  return part_correlation(sums);
}

}  // namespace detail

float zncc_scalar(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at) {
  const auto max_x = static_cast<float>(source.width() - 2);
  const auto max_y = static_cast<float>(source.height() - 2);
  ZnccSums sums;
  for (std::size_t k = 0; k < kPaddedTexels; ++k) {
    const float x = at.x[k];
    const float y = at.y[k];
    if (!(x >= 1.0f && y >= 1.0f && x <= max_x && y <= max_y))
      return detail::zncc_of_part(patch, source, at);
    const float value = bilinear(source, x, y) - patch.mean;
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
