// SPDX-License-Identifier: GPL-3.0-or-later
// The last step of ZNCC: from sums over the texels to the correlation.
#pragma once

#include <array>
#include <cmath>

#include "depth/patch/reference_patch.h"

namespace axial::depth {
namespace {  // one copy per translation unit: instruction sets must not share this code

// Weighted sums over the texels, with one partial sum for each of eight SIMD lanes. Lane k sums
// over the texels k, k + 8, and so on. `weight` and `deviation` are those of ReferencePatch. v is
// the grey level (0 to 255) in the source image minus ReferencePatch::mean. The sums are of weight
// * v (mean), weight * v^2 (square) and deviation * v (cross).
struct ZnccSums {
  alignas(32) std::array<float, 8> mean{};
  alignas(32) std::array<float, 8> square{};
  alignas(32) std::array<float, 8> cross{};
};

// The sum of the partial sums. All implementations of ZNCC add in this order.
inline float reduce(const std::array<float, 8>& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// Returns the correlation in [-1, 1], or kNoCorrelation if the source patch is flat (kFlatVariance)
// or `reference_variance` is 0. `reference_variance`: ReferencePatch::variance.
inline float correlation(const ZnccSums& sums, float reference_variance) {
  const float mean = reduce(sums.mean);
  const float variance = reduce(sums.square) - mean * mean;
  if (!(variance > kFlatVariance) || !(reference_variance > 0)) return kNoCorrelation;
  const float value = reduce(sums.cross) / std::sqrt(reference_variance * variance);
  return value > 1.0f ? 1.0f : value < -1.0f ? -1.0f : value;
}

}  // namespace
}  // namespace axial::depth
