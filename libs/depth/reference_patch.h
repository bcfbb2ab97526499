// SPDX-License-Identifier: GPL-3.0-or-later
// The matching window: every second pixel of 9x9 pixels, which are 25 texels around the reference
// pixel. Also the constants that all scorers share. Plain data only, because translation units for
// all instruction sets include this file.
#pragma once

#include <array>
#include <cstddef>

namespace axial::depth {

inline constexpr int kPatchRadius = 4;
inline constexpr int kPatchStep = 2;
inline constexpr int kTexels = 25;
inline constexpr int kCentreTexel = 12;
inline constexpr int kPaddedTexels = 32;  // four vectors of eight; the padding has weight zero

// The reference window. Computed once per pixel, used for all hypotheses and source views.
struct ReferencePatch {
  alignas(32) std::array<float, kPaddedTexels> weight;     // bilateral, sums to 1
  alignas(32) std::array<float, kPaddedTexels> deviation;  // weight * (intensity - mean)
  // Weighted mean of the intensities, 0 to 255. It is subtracted from the source's grey levels,
  // too, to keep their sums small.
  float mean;
  float variance;  // sum of weight * (intensity - mean)^2 with intensities from 0 to 1
  float texture;   // the same sum with the weights before normalisation, which are at most 1
};

inline constexpr float kOutsideCost = 1.2f;  // cost of a patch without a correlation
inline constexpr float kMaxCost = 2.0f;

// The result for a patch that has no correlation: its centre lies outside the source image or is
// NaN, too little of it lies inside, or it is flat. Less than every correlation.
inline constexpr float kNoCorrelation = -2.0f;

// The weight of a texel is multiplied by the texel's share: its distance to the edge of the source
// image [px], from 0 at the edge to 1 at one pixel or more. So the correlation is a continuous
// function of the hypothesis. A patch has a correlation if the sum of these products is at least
// kLeastWeight (for a patch inside the image, the sum is 1).
inline constexpr float kLeastWeight = 0.3f;

// A source patch is flat if its variance [grey levels^2] is not above this value.
inline constexpr float kFlatVariance = 0.25f;
// The part of a reference patch that a source image shows is flat if its variance, of intensities
// from 0 to 1, is not above this value.
inline constexpr float kFlatReference = kFlatVariance / (255 * 255);

// Largest relative difference of depth at which the depth map of a source view still shows the same
// surface.
inline constexpr float kSameSurface = 0.03f;

}  // namespace axial::depth
