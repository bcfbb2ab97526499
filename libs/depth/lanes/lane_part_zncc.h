// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of windows that lie partly outside their source images. They are rare, and need three times
// the work of whole windows, so they have their own loop.
#pragma once

#include "depth/lanes/lane_images.h"
#include "depth/lanes/lane_texel.h"
#include "depth/part_sums.h"
#include "depth/reference_patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth::lanes {

// The window of each lane in its source image: the position of its centre [px], and the affine warp
// around the centre.
template <class Abi>
struct LaneWindow {
  Pack<Abi> x, y;
  refractive::Matrix2<Pack<Abi>> warp;
};

namespace {  // one copy per translation unit: the linker would merge those of one instruction set

// The correlation of each lane in [-1, 1], or kNoCorrelation. Texels outside are not sampled.
template <class Abi>
[[gnu::noinline]] Pack<Abi> lane_part_zncc(const ReferencePatch& patch, const std::uint32_t* words,
                                           const LaneImages<Abi>& image,
                                           const LaneWindow<Abi>& window) {
  using T = Pack<Abi>;
  using Ints = typename T::Ints;
  constexpr int kSide = 5;
  const T right = image.width - T(1), bottom = image.height - T(1);
  const LaneSampler<Abi> sample(words, image.begin, stdx::static_simd_cast<Ints>(image.width.part));
  const auto fixed = [](const T& position) {
    return stdx::static_simd_cast<Ints>((position * T(kPositionUnit)).part);
  };
  PartSums<T> sums;
  for (int k = 0; k < kTexels; ++k) {
    const float weight = patch.weight[static_cast<std::size_t>(k)];
    if (!(weight > 0)) continue;
    const T dx(k % kSide * kPatchStep - kPatchRadius), dy(k / kSide * kPatchStep - kPatchRadius);
    const T x = window.x + window.warp(0, 0) * dx + window.warp(0, 1) * dy;
    const T y = window.y + window.warp(1, 0) * dx + window.warp(1, 1) * dy;
    const T share = share_inside(x, y, right, bottom);
    const PackMask<Abi> inside = share > T(0);
    const T grey(sample(fixed(select(inside, x, T(0))), fixed(select(inside, y, T(0)))));
    sums.add(share, weight, patch.deviation[static_cast<std::size_t>(k)],
             grey * T(1 / kGreyUnit) - T(patch.mean));
  }
  return sums.correlation();
}

}  // namespace
}  // namespace axial::depth::lanes
