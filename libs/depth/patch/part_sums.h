// SPDX-License-Identifier: GPL-3.0-or-later
// Correlation of a matching window that lies partly outside the source image. Only the texels
// inside the image count. T is float or a SIMD pack.
#pragma once

#include <cmath>

#include "depth/patch/reference_patch.h"
#include "refractive/scalar.h"

namespace axial::depth {

// The sums of ZNCC over the texels of a window. In each sum, a texel's summand is multiplied by
// the texel's share s, from 0 to 1 (see kLeastWeight). w: the weight in the reference patch. d:
// the intensity (0 to 1) in the reference patch minus the patch's mean. v: the grey level (0 to
// 255) in the source patch minus a constant of the window.
template <class T>
struct PartSums {
  T weights = T(0);           // s w
  T reference = T(0);         // s w d
  T reference_square = T(0);  // s w d^2
  T mean = T(0);              // s w v
  T square = T(0);            // s w v^2
  T cross = T(0);             // s w d v
};

namespace {  // one copy per translation unit: instruction sets must not share this code

// The value w d^2 of texel k (PartSums), without the share.
inline float reference_square(const ReferencePatch& patch, std::size_t k) {
  return patch.weight[k] > 0 ? patch.deviation[k] * patch.deviation[k] / patch.weight[k] : 0.0f;
}

// Returns the correlation in [-1, 1]. Returns kNoCorrelation if the sum of weights is below
// kLeastWeight, or if the source patch or the reference patch is flat over the texels inside the
// image.
template <class T>
T part_correlation(const PartSums<T>& sums) {
  using refractive::greater;
  using refractive::lesser;
  using refractive::select;
  using std::sqrt;
  const auto enough = sums.weights >= T(kLeastWeight);
  const T all = select(enough, sums.weights, T(1));
  const T mean = sums.mean / all, reference = sums.reference / all;
  const T variance = sums.square / all - mean * mean;
  const T reference_variance = sums.reference_square / all - reference * reference;
  const auto known =
      enough && variance > T(kFlatVariance) && reference_variance > T(kFlatReference);
  const T value = (sums.cross / all - mean * reference) /
                  sqrt(select(known, T(variance * reference_variance), T(1)));
  return select(known, lesser(greater(value, T(-1)), T(1)), T(kNoCorrelation));
}

}  // namespace
}  // namespace axial::depth
