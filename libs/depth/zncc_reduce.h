// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

#include "depth/zncc.h"

namespace axial::depth {
namespace {  // one copy per translation unit: instruction sets must not share this code

// Weighted sums over the texels, with one partial sum for each of eight SIMD lanes. v is the grey
// level (0 to 255) in the source image minus ReferencePatch::mean. The sums are of weight * v
// (mean), weight * v^2 (square) and deviation * v (cross).
struct ZnccSums {
  alignas(32) std::array<float, 8> mean{};
  alignas(32) std::array<float, 8> square{};
  alignas(32) std::array<float, 8> cross{};
};

inline float reduce(const std::array<float, 8>& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

inline float correlation(const ZnccSums& sums, float reference_variance) {
  const float mean = reduce(sums.mean);
  const float variance = reduce(sums.square) - mean * mean;
  if (!(variance > kFlatVariance) || !(reference_variance > 0)) return kNoCorrelation;
  const float value = reduce(sums.cross) / std::sqrt(reference_variance * variance);
  return value > 1.0f ? 1.0f : value < -1.0f ? -1.0f : value;
}

}  // namespace
}  // namespace axial::depth
