// SPDX-License-Identifier: GPL-3.0-or-later
// The matching window, 9x9 pixels, every second one: 25 texels around a reference pixel. Also what
// all scorers agree on. Plain data: translation units of every instruction set include this.
#pragma once

#include <array>
#include <cstddef>

namespace axial::depth {

inline constexpr int kPatchRadius = 4;
inline constexpr int kPatchStep = 2;
inline constexpr int kTexels = 25;
inline constexpr int kCentreTexel = 12;
inline constexpr int kPaddedTexels = 32;  // four vectors of eight; the rest has weight zero

// The reference window gathered once per pixel and reused for every hypothesis and source view.
struct ReferencePatch {
  alignas(32) std::array<float, kPaddedTexels> weight;     // bilateral, sums to 1
  alignas(32) std::array<float, kPaddedTexels> deviation;  // weight * (intensity - mean)
  float mean;      // weighted mean of the intensities, 0 to 255: keeps the source's sums small
  float variance;  // sum of weight * (intensity - mean)^2, weights summing to 1
  float texture;   // the same with weights of at most 1: what OpenMVS's threshold means

  // weight * (intensity - mean)^2 of a texel.
  float square(std::size_t k) const {
    return weight[k] > 0 ? deviation[k] * deviation[k] / weight[k] : 0.0f;
  }
};

inline constexpr float kOutsideCost = 1.2f;  // of a patch without a correlation
inline constexpr float kMaxCost = 2.0f;

// Correlation of a patch whose centre lies outside the source image or is not a number, of which
// too little lies inside, or which is flat there. Below every possible correlation.
inline constexpr float kNoCorrelation = -2.0f;

// A texel counts in full if it lies at least a pixel inside the source image, and ever less towards
// the image's edge, so that the correlation is a continuous function of the hypothesis. A patch has
// a correlation if the texels that count have at least this share of all weights.
inline constexpr float kLeastWeight = 0.3f;

// A source patch with less variance [grey levels^2] tells nothing.
inline constexpr float kFlatVariance = 0.25f;
// Nor does the part of a reference patch that a source image shows, if it has less than this
// variance, of intensities from 0 to 1.
inline constexpr float kFlatReference = kFlatVariance / (255 * 255);

// Relative difference of depth within which a source view's depth map shows the same surface.
inline constexpr float kSameSurface = 0.03f;

}  // namespace axial::depth
