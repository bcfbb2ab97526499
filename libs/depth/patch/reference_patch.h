// SPDX-License-Identifier: GPL-3.0-or-later
// The matching window around a reference pixel, and the constants that all scorers share. The
// window has 25 texels: in each direction, every second of 9 pixels. This file contains only plain
// data, because translation units for all instruction sets include it.
#pragma once

#include <array>
#include <cstddef>

namespace axial::depth {

inline constexpr int kPatchRadius = 4;    // from the centre to the outermost texels [px]
inline constexpr int kPatchStep = 2;      // between texels [px]
inline constexpr int kTexels = 25;        // number of texels
inline constexpr int kCentreTexel = 12;   // index of the texel at the centre
inline constexpr int kPaddedTexels = 32;  // four vectors of eight; the padding has weight zero

// The window around a reference pixel. It is computed once per pixel and used for all hypotheses
// and source views. Texels are in row-major order.
struct ReferencePatch {
  // Bilateral weights (PatchMatchOptions::sigma_color and sigma_space). Their sum is 1.
  alignas(32) std::array<float, kPaddedTexels> weight;
  // weight * (intensity - mean intensity), with intensities from 0 to 1.
  alignas(32) std::array<float, kPaddedTexels> deviation;
  // Weighted mean of the grey levels, 0 to 255. ZNCC subtracts this mean from the grey levels of
  // the source image, too, so that the sums over these grey levels stay small.
  float mean;
  float variance;  // sum of weight * (intensity - mean intensity)^2, with intensities from 0 to 1
  float texture;   // `variance` times the sum of the weights before they were divided by this sum
};

inline constexpr float kOutsideCost = 1.2f;  // cost of a patch without a correlation
inline constexpr float kMaxCost = 2.0f;      // largest cost

// The result for a patch without a correlation. A patch has no correlation if its centre lies
// outside the source image or is NaN, if too little of the patch lies inside the image
// (kLeastWeight), or if the source patch or the reference patch is flat. The value is less than
// every correlation.
inline constexpr float kNoCorrelation = -2.0f;

// The smallest sum of weights with which a patch has a correlation. In this sum, each texel's
// weight is multiplied by the texel's share. The share is the distance of the texel to the edge
// of the source image [px], reduced to 1 if larger, and 0 outside the image. So the correlation
// is a continuous function of the hypothesis. For a patch inside the image, the sum is 1.
inline constexpr float kLeastWeight = 0.3f;

// A source patch is flat if its variance [grey levels^2] is not above this value.
inline constexpr float kFlatVariance = 0.25f;
// A reference patch is flat if its variance is not above this value, for intensities from 0 to 1.
// This limit applies only if the source patch lies partly outside its image. The variance is then
// computed over the part inside. For a source patch inside its image, the reference patch is flat
// only if its variance is 0.
inline constexpr float kFlatReference = kFlatVariance / (255 * 255);

// If the depth in the map of a source view differs from the depth of a hypothesis by less than this
// share of the hypothesis's depth, both count as the same surface.
inline constexpr float kSameSurface = 0.03f;

}  // namespace axial::depth
