// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch.h"

#include <cmath>
#include <cstdlib>

namespace axial::depth {

PatchSampler::PatchSampler(const PatchMatchOptions& options) {
  for (std::size_t i = 0; i < color_weight_.size(); ++i) {
    const float difference = static_cast<float>(i) / 255.0f;
    color_weight_[i] =
        std::exp(-difference * difference / (2 * options.sigma_color * options.sigma_color));
  }
  for (std::size_t k = 0; k < kTexels; ++k) {
    const float squared =
        kTexelOffsets.x[k] * kTexelOffsets.x[k] + kTexelOffsets.y[k] * kTexelOffsets.y[k];
    space_weight_[k] = std::exp(-squared / (2 * options.sigma_space * options.sigma_space));
  }
}

ReferencePatch PatchSampler::gather(const cv::Mat1b& image, int x, int y) const {
  ReferencePatch patch;
  std::array<float, kTexels> intensity;
  const int centre = image(y, x);
  float weight_sum = 0;
  float mean = 0;
  std::size_t k = 0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; dy += kPatchStep) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y + dy) + x;
    for (int dx = -kPatchRadius; dx <= kPatchRadius; dx += kPatchStep, ++k) {
      const int value = row[dx];
      const float weight =
          color_weight_[static_cast<std::size_t>(std::abs(value - centre))] * space_weight_[k];
      intensity[k] = static_cast<float>(value) * (1.0f / 255.0f);
      patch.weight[k] = weight;
      weight_sum += weight;
      mean += weight * intensity[k];
    }
  }
  mean /= weight_sum;
  patch.mean = mean * 255.0f;
  const float inverse_sum = 1.0f / weight_sum;
  for (k = 0; k < kTexels; ++k) {
    const float deviation = intensity[k] - mean;
    patch.weight[k] *= inverse_sum;
    patch.deviation[k] = patch.weight[k] * deviation;
    patch.variance += patch.deviation[k] * deviation;
  }
  patch.texture = patch.variance * weight_sum;
  return patch;
}

}  // namespace axial::depth
