// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of a matching window that lies partly outside the source image, over the texels inside. T is
// float or a SIMD pack.
#pragma once

#include <cmath>

#include "depth/reference_patch.h"
#include "refractive/scalar.h"

namespace axial::depth {
namespace {  // one copy per translation unit: instruction sets must not share this code

// The factor of the weight of a texel at (x, y) [px]: its distance to the image's edge, from 0 to 1
// (see kLeastWeight). 0 if x or y is NaN. `right`, `bottom`: the image's last column and row.
template <class T>
T share_inside(const T& x, const T& y, const T& right, const T& bottom) {
  using refractive::lesser;
  using refractive::select;
  const auto inside = x > T(0) && y > T(0) && x < right && y < bottom;
  const T least = lesser(lesser(x, right - x), lesser(y, bottom - y));
  return select(inside, lesser(least, T(1)), T(0));
}

// The sums of ZNCC, weighted by the reference patch's weights times the texels' share_inside().
template <class T>
class PartSums {
 public:
  // Adds one texel. `weight`, `deviation`: from the ReferencePatch; precondition: weight > 0.
  // `value`: the source's grey level minus a constant, which can be any number.
  void add(const T& share, float weight, float deviation, const T& value) {
    const T counted = share * T(weight);
    const T reference = share * T(deviation);
    weights_ += counted;
    reference_ += reference;
    reference_square_ += reference * T(deviation / weight);
    mean_ += counted * value;
    square_ += counted * value * value;
    cross_ += reference * value;
  }

  // The correlation in [-1, 1]; kNoCorrelation if the texels inside have too little weight
  // (kLeastWeight) or if one of the patches is flat (kFlatVariance, kFlatReference).
  T correlation() const {
    using refractive::greater;
    using refractive::lesser;
    using refractive::select;
    using std::sqrt;
    const auto enough = weights_ >= T(kLeastWeight);
    const T all = select(enough, weights_, T(1));
    const T mean = mean_ / all, reference = reference_ / all;
    const T variance = square_ / all - mean * mean;
    const T reference_variance = reference_square_ / all - reference * reference;
    const auto known =
        enough && variance > T(kFlatVariance) && reference_variance > T(kFlatReference);
    const T value = (cross_ / all - mean * reference) /
                    sqrt(select(known, T(variance * reference_variance), T(1)));
    return select(known, lesser(greater(value, T(-1)), T(1)), T(kNoCorrelation));
  }

 private:
  T weights_ = T(0), reference_ = T(0), reference_square_ = T(0);
  T mean_ = T(0), square_ = T(0), cross_ = T(0);
};

}  // namespace
}  // namespace axial::depth
