// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of one reference patch with a source patch per lane, and depths near an expected one.
#pragma once

#include "depth/lanes/lane_texel.h"
#include "depth/reference_patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth::lanes {

// The source image of every lane: where it begins in the run of all images, and its size.
template <class Abi>
struct LaneImages {
  typename Pack<Abi>::Ints begin;
  Pack<Abi> width, height;
};

namespace detail {

template <class Abi>
auto gather_floats(const float* base, const typename Pack<Abi>::Ints& at) {
  using Part = typename Pack<Abi>::Part;
#ifdef __AVX512F__
  if constexpr (Part::size() == 16)
    return Part(_mm512_i32gather_ps(static_cast<__m512i>(at), base, 4));
  else
#elif defined(__AVX2__)
  if constexpr (Part::size() == 8)
    return Part(_mm256_i32gather_ps(base, static_cast<__m256i>(at), 4));
  else
#endif
    return Part([&](auto k) { return base[at[k]]; });
}

}  // namespace detail

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

// Bilinear depth among those of the four pixels around a position that lie within kSameSurface
// (relative) of the expected depth; 0 if none does or the position is outside.
template <class Abi>
Pack<Abi> lane_depth_near(const float* depths, const LaneImages<Abi>& image,
                          const refractive::Projection<Pack<Abi>>& at, const Pack<Abi>& expected) {
  using T = Pack<Abi>;
  using Part = typename T::Part;
  using Ints = typename T::Ints;
  const T& x = at.pixel.x();
  const T& y = at.pixel.y();
  const PackMask<Abi> inside =
      at.visible && x >= T(0) && y >= T(0) && x <= image.width - T(1) && y <= image.height - T(1);
  T found;
  Part px = x.part, py = y.part;
  stdx::where(!inside.part, px) = Part(0.0f);
  stdx::where(!inside.part, py) = Part(0.0f);
  const Ints width = stdx::static_simd_cast<Ints>(image.width.part);
  const Ints height = stdx::static_simd_cast<Ints>(image.height.part);
  const Ints column = stdx::min(stdx::static_simd_cast<Ints>(px), width - 2);
  const Ints row = stdx::min(stdx::static_simd_cast<Ints>(py), height - 2);
  const Part fx = px - stdx::static_simd_cast<Part>(column);
  const Part fy = py - stdx::static_simd_cast<Part>(row);
  Part sum(0.0f), weights(0.0f);
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const Ints index = image.begin + (row + dy) * width + (column + dx);
      const Part value = detail::gather_floats<Abi>(depths, index);
      Part weight = (dx ? fx : Part(1.0f) - fx) * (dy ? fy : Part(1.0f) - fy) + Part(1e-6f);
      const auto near = stdx::abs(value - expected.part) < kSameSurface * expected.part;
      stdx::where(!near, weight) = Part(0.0f);
      sum += weight * value;
      weights += weight;
    }
  }
  const auto some = weights > Part(0.0f);
  stdx::where(!some, weights) = Part(1.0f);
  Part depth = sum / weights;
  stdx::where(!some || !inside.part, depth) = Part(0.0f);
  found.part = depth;
  return found;
}

}  // namespace axial::depth::lanes
