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
inline constexpr int kPaddedTexels = 32;  // four vectors of eight; the rest has weight zero

// The reference window gathered once per pixel and reused for every hypothesis and source view.
struct ReferencePatch {
  alignas(32) std::array<float, kPaddedTexels> weight;     // bilateral, sums to 1
  alignas(32) std::array<float, kPaddedTexels> deviation;  // weight * (intensity - mean)
  float mean;      // weighted mean of the intensities, 0 to 255: keeps the source's sums small
  float variance;  // sum of weight * (intensity - mean)^2, weights summing to 1
  float texture;   // the same with weights of at most 1: what OpenMVS's threshold means
};

inline constexpr float kOutsideCost = 1.2f;  // of a patch that leaves the source image
inline constexpr float kMaxCost = 2.0f;

// Correlation of a patch that leaves the source image (a border of one pixel kept), is not a
// number, or is flat in the source image. Below every possible correlation.
inline constexpr float kNoCorrelation = -2.0f;

// A source patch with less variance [grey levels^2] tells nothing.
inline constexpr float kFlatVariance = 0.25f;

// Relative difference of depth within which a source view's depth map shows the same surface.
inline constexpr float kSameSurface = 0.03f;

}  // namespace axial::depth
