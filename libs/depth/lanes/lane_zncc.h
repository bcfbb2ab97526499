// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of one reference patch with a source patch per lane.
#pragma once

#include "depth/lanes/lane_images.h"
#include "depth/lanes/lane_texel.h"
#include "depth/reference_patch.h"

namespace axial::depth::lanes {

// Correlation in [-1, 1], or kNoCorrelation as ZnccFunction gives it, in the lanes up to `used`.
// The bounds are tested at the window's corners: the warp is affine. Rounding the centre and the
// steps to 1/65536 pixel moves no sample by more than 1e-3 pixels, and the border that is kept is a
// whole one, so that all samples lie where LaneSampler takes them.
template <class Abi>
Pack<Abi> lane_zncc(const ReferencePatch& patch, const std::uint32_t* words,
                    const LaneImages<Abi>& image, const refractive::Projection<Pack<Abi>>& centre,
                    const refractive::Matrix2<Pack<Abi>>& warp) {
  using T = Pack<Abi>;
  using Part = typename T::Part;
  using Ints = typename T::Ints;
  constexpr int kSide = 5;
  const T reach(static_cast<float>(kPatchRadius));
  const T extent_x = abs(warp(0, 0)) * reach + abs(warp(0, 1)) * reach;
  const T extent_y = abs(warp(1, 0)) * reach + abs(warp(1, 1)) * reach;
  const T& x = centre.pixel.x();
  const T& y = centre.pixel.y();
  const PackMask<Abi> inside = centre.visible && x - extent_x >= T(1) && y - extent_y >= T(1) &&
                               x + extent_x <= image.width - T(2) &&
                               y + extent_y <= image.height - T(2);
  if (stdx::none_of(inside.part)) return T(kNoCorrelation);

  const Part grey_mean(patch.mean * kGreyUnit);
  const auto fixed = [&](const T& value, float otherwise) {
    Part part = value.part;
    stdx::where(!inside.part, part) = Part(otherwise);
    return stdx::static_simd_cast<Ints>(part * Part(kPositionUnit));
  };
  const Ints xu = fixed(warp(0, 0), 0), xv = fixed(warp(0, 1), 0);
  const Ints yu = fixed(warp(1, 0), 0), yv = fixed(warp(1, 1), 0);
  const LaneSampler<Abi> sample(words, image.begin, stdx::static_simd_cast<Ints>(image.width.part));
  Ints row_x = fixed(x, 1) - (xu + xv) * kPatchRadius;
  Ints row_y = fixed(y, 1) - (yu + yv) * kPatchRadius;
  T mean(0), square(0), cross(0);
  std::size_t texel = 0;
  for (int j = 0; j < kSide; ++j, row_x += xv * kPatchStep, row_y += yv * kPatchStep) {
    Ints at_x = row_x, at_y = row_y;
    for (int i = 0; i < kSide; ++i, ++texel, at_x += xu * kPatchStep, at_y += yu * kPatchStep) {
      const Part value = sample(at_x, at_y) - grey_mean;
      const Part weighted = Part(patch.weight[texel]) * value;
      mean.part += weighted;
      square.part += weighted * value;
      cross.part += Part(patch.deviation[texel]) * value;
    }
  }
  const T variance = square - mean * mean;
  const T flat(kFlatVariance * kGreyUnit * kGreyUnit);
  const PackMask<Abi> known = inside && variance > flat && T(patch.variance) > T(0);
  const T value = cross / sqrt(T(patch.variance) * select(known, variance, T(1)));
  return select(known, min(max(value, T(-1)), T(1)), T(kNoCorrelation));
}

}  // namespace axial::depth::lanes
