// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch/patch.h"

#include <cmath>

namespace axial::depth {

PatchSampler::PatchSampler(const PatchMatchOptions& options) {
  for (std::size_t i = 0; i < color_weight_.size(); ++i) {
    const float difference = (static_cast<float>(i) - 255.0f) / 255.0f;
    color_weight_[i] =
        std::exp(-difference * difference / (2 * options.sigma_color * options.sigma_color));
  }
  for (std::size_t k = 0; k < kTexels; ++k) {
    const float squared =
        kTexelOffsets.x[k] * kTexelOffsets.x[k] + kTexelOffsets.y[k] * kTexelOffsets.y[k];
    space_weight_[k] = std::exp(-squared / (2 * options.sigma_space * options.sigma_space));
  }
}

template <bool kWhole>
void PatchSampler::gather_window(const cv::Mat1b& image, int x, int y,
                                 ReferencePatch& patch) const {
  constexpr int kSide = 2 * kPatchRadius / kPatchStep + 1;
  std::array<float, kTexels> grey;
  // One sum per column: with a single sum, each addition would wait for the one before.
  std::array<float, kSide> weights{}, weighted{}, squares{};
  const float* color_weight = color_weight_.data() + 255 - image(y, x);
  std::size_t k = 0;
  for (int j = 0; j < kSide; ++j) {
    const int texel_y = y - kPatchRadius + j * kPatchStep;
    const bool row_inside = kWhole || (texel_y >= 0 && texel_y < image.rows);
    const auto* row = image.ptr<std::uint8_t>(row_inside ? texel_y : y);
    for (std::size_t i = 0; i < kSide; ++i, ++k) {
      const int texel_x = x - kPatchRadius + static_cast<int>(i) * kPatchStep;
      const bool inside = kWhole || (row_inside && texel_x >= 0 && texel_x < image.cols);
      const std::uint8_t value = row[inside ? texel_x : x];
      const float weight = inside ? color_weight[value] * space_weight_[k] : 0.0f;
      grey[k] = value;
      patch.weight[k] = weight;
      weights[i] += weight;
      weighted[i] += weight * grey[k];
    }
  }
  const auto sum = [](const std::array<float, kSide>& a) {
    return ((a[0] + a[1]) + (a[2] + a[3])) + a[4];
  };
  const float weight_sum = sum(weights);
  const float inverse = 1.0f / weight_sum;
  patch.mean = sum(weighted) * inverse;
  for (std::size_t first = 0; first < kTexels; first += kSide) {
    for (std::size_t i = 0; i < kSide; ++i) {
      const float deviation = (grey[first + i] - patch.mean) * (1.0f / 255.0f);
      patch.weight[first + i] *= inverse;
      patch.deviation[first + i] = patch.weight[first + i] * deviation;
      squares[i] += patch.deviation[first + i] * deviation;
    }
  }
  for (k = kTexels; k < kPaddedTexels; ++k) patch.weight[k] = patch.deviation[k] = 0;
  patch.variance = sum(squares);
  patch.texture = patch.variance * weight_sum;
}

void PatchSampler::gather(const cv::Mat1b& image, int x, int y, ReferencePatch& patch) const {
  if (window_inside(x, y, image.cols, image.rows))
    gather_window<true>(image, x, y, patch);
  else
    gather_window<false>(image, x, y, patch);
}

}  // namespace axial::depth
