// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of one reference patch with one source patch per SIMD lane.
#pragma once

#include "depth/lanes/lane_images.h"
#include "depth/lanes/lane_texel.h"
#include "depth/patch/part_sums.h"
#include "depth/patch/reference_patch.h"

namespace axial::depth::lanes {

// The window of every lane in its source image. Positions and steps [px] are 16.16 fixed-point
// numbers.
template <class Abi>
struct LaneWindow {
  using Ints = typename Pack<Abi>::Ints;
  Ints x, y;              // position of the first texel
  Ints right_x, right_y;  // the step to the next texel of a row
  Ints down_x, down_y;    // the step to the next row
  // The members below are set only if the window of some lane lies partly outside its image.
  Ints last_x, last_y;  // the last column and row of the image
  Ints whole;           // 1 in lanes whose whole window lies inside the image, else 0
};

namespace {  // one copy per translation unit: instruction sets must not share this code

// Computes the sums over one window per lane. Grey levels are multiplied by kGreyUnit, so
// PartSums::mean and PartSums::cross have this factor and PartSums::square has its square. With
// kPart, windows may lie partly outside their images. A texel outside its image then has a share
// (kLeastWeight) of 0, and its sample is taken at the edge of the image. Without kPart, all windows
// must lie inside their images, and the sums `weights`, `reference` and `reference_square` stay 0.
// The sums `mean`, `square` and `cross` of a window inside its image have the same bytes with and
// without kPart.
template <bool kPart, class Abi>
PartSums<Pack<Abi>> window_sums(const ReferencePatch& patch, const LaneSampler<Abi>& sample,
                                const LaneWindow<Abi>& window) {
  using Part = typename Pack<Abi>::Part;
  using Ints = typename Pack<Abi>::Ints;
  constexpr int kSide = 5;
  constexpr int kWholeShare = static_cast<int>(kPositionUnit);
  const Part grey_mean(patch.mean * kGreyUnit);
  PartSums<Pack<Abi>> sums;
  Ints row_x = window.x, row_y = window.y;
  std::size_t texel = 0;
  for (int j = 0; j < kSide; ++j, row_x += window.down_x, row_y += window.down_y) {
    Ints x = row_x, y = row_y;
    for (int i = 0; i < kSide; ++i, ++texel, x += window.right_x, y += window.right_y) {
      Part weight(patch.weight[texel]), deviation(patch.deviation[texel]);
      Ints at_x = x, at_y = y;
      if constexpr (kPart) {
        const Ints room = min(min(x, window.last_x - x), min(y, window.last_y - y));
        const Ints counted =
            max(min(max(room, Ints(0)), Ints(kWholeShare)), Ints(window.whole * kWholeShare));
        const Part share = stdx::static_simd_cast<Part>(counted) * Part(1 / kPositionUnit);
        weight *= share;
        deviation *= share;
        sums.weights.part += weight;
        sums.reference.part += deviation;
        sums.reference_square.part += share * Part(reference_square(patch, texel));
        at_x = max(min(x, window.last_x - 1), Ints(0));
        at_y = max(min(y, window.last_y - 1), Ints(0));
      }
      const Part value = sample(at_x, at_y) - grey_mean;
      const Part weighted = weight * value;
      sums.mean.part += weighted;
      sums.square.part += weighted * value;
      sums.cross.part += deviation * value;
    }
  }
  return sums;
}

// Returns the correlation in the lanes of `whole`, whose windows lie completely inside their
// images. Returns kNoCorrelation in the other lanes, and where the source patch or the reference
// patch is flat. `sums`: the result of window_sums().
template <class Abi>
Pack<Abi> whole_correlation(const ReferencePatch& patch, const PartSums<Pack<Abi>>& sums,
                            const PackMask<Abi>& whole) {
  using T = Pack<Abi>;
  const T variance = sums.square - sums.mean * sums.mean;
  const T flat(kFlatVariance * kGreyUnit * kGreyUnit);
  const PackMask<Abi> known = whole && variance > flat && T(patch.variance) > T(0);
  const T value = sums.cross / sqrt(T(patch.variance) * select(known, variance, T(1)));
  return select(known, min(max(value, T(-1)), T(1)), T(kNoCorrelation));
}

// Returns the correlation of each lane if some windows lie partly outside their images. The windows
// of the lanes in `whole` lie completely inside their images, the windows of the lanes in `partly`
// lie partly outside. The other lanes get kNoCorrelation. This function is separate from
// lane_zncc() because its case is rare and its code would slow down the usual case.
template <class Abi>
[[gnu::noinline]] Pack<Abi> lane_zncc_of_parts(const ReferencePatch& patch,
                                               const LaneSampler<Abi>& sample,
                                               const LaneWindow<Abi>& window,
                                               const PackMask<Abi>& whole,
                                               const PackMask<Abi>& partly) {
  using T = Pack<Abi>;
  PartSums<T> sums = window_sums<true>(patch, sample, window);
  const T of_whole = whole_correlation(patch, sums, whole);
  sums.mean *= T(1 / kGreyUnit);
  sums.square *= T(1 / kGreyUnit / kGreyUnit);
  sums.cross *= T(1 / kGreyUnit);
  return select(partly, part_correlation(sums), of_whole);
}

}  // namespace

// Returns the correlation of each lane in [-1, 1], or kNoCorrelation if the centre of the patch is
// not visible or the patch has no correlation (kNoCorrelation in reference_patch.h). `words`:
// SceneTables::words. `image`: each lane's source image. `centre`: the patch's centre in this image
// [px]. `warp`: d(source pixel)/d(reference pixel).
//
// The result of a lane does not depend on the other lanes. The warp is affine, so a test of the
// window's corners tells whether the whole window is inside the image. The centre of the window and
// the steps between texels are rounded to 1/65536 px, which moves samples by at most 1e-3 px. A
// window counts as inside only if it is at least one pixel from the image's edge, so that its
// samples meet the precondition of LaneSampler.
template <class Abi>
Pack<Abi> lane_zncc(const ReferencePatch& patch, const std::uint32_t* words,
                    const LaneImages<Abi>& image, const refractive::Projection<Pack<Abi>>& centre,
                    const refractive::Matrix2<Pack<Abi>>& warp) {
  using T = Pack<Abi>;
  using Part = typename T::Part;
  using Ints = typename T::Ints;
  const T reach(static_cast<float>(kPatchRadius));
  const T extent_x = abs(warp(0, 0)) * reach + abs(warp(0, 1)) * reach;
  const T extent_y = abs(warp(1, 0)) * reach + abs(warp(1, 1)) * reach;
  const T& x = centre.pixel.x();
  const T& y = centre.pixel.y();
  const PackMask<Abi> whole = centre.visible && x - extent_x >= T(1) && y - extent_y >= T(1) &&
                              x + extent_x <= image.width - T(2) &&
                              y + extent_y <= image.height - T(2);
  // Texels farther out have positions that 16.16 fixed point cannot represent.
  const T farthest(static_cast<float>(kLargestSide));
  const PackMask<Abi> partly = centre.visible && !whole && x > T(0) && y > T(0) &&
                               x < image.width - T(1) && y < image.height - T(1) &&
                               extent_x <= farthest - x && extent_y <= farthest - y;
  const PackMask<Abi> used{whole.part || partly.part};
  if (stdx::none_of(used.part)) return T(kNoCorrelation);

  const auto fixed = [&](const T& value, float otherwise) {
    const Part part = blend(used.part, value.part, Part(otherwise));
    return stdx::static_simd_cast<Ints>(part * Part(kPositionUnit));
  };
  const Ints xu = fixed(warp(0, 0), 0), xv = fixed(warp(0, 1), 0);
  const Ints yu = fixed(warp(1, 0), 0), yv = fixed(warp(1, 1), 0);
  LaneWindow<Abi> window;
  window.x = fixed(x, 1) - (xu + xv) * kPatchRadius;
  window.y = fixed(y, 1) - (yu + yv) * kPatchRadius;
  window.right_x = xu * kPatchStep, window.right_y = yu * kPatchStep;
  window.down_x = xv * kPatchStep, window.down_y = yv * kPatchStep;
  const LaneSampler<Abi> sample(words, image.begin, stdx::static_simd_cast<Ints>(image.width.part));
  if (stdx::any_of(partly.part)) {
    window.last_x = fixed(image.width - T(1), 1), window.last_y = fixed(image.height - T(1), 1);
    window.whole = stdx::static_simd_cast<Ints>(select(partly, T(0), T(1)).part);
    return lane_zncc_of_parts(patch, sample, window, whole, partly);
  }
  return whole_correlation(patch, window_sums<false>(patch, sample, window), whole);
}

}  // namespace axial::depth::lanes
