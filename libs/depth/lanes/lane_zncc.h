// SPDX-License-Identifier: GPL-3.0-or-later
// ZNCC of one reference patch with a source patch per lane, and depths near an expected one.
#pragma once

#include "depth/lanes/pack.h"
#include "depth/reference_patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth::lanes {

// The source image of every lane: where it begins in the run of all images, and its size.
template <class Abi>
struct LaneImages {
  alignas(64) std::array<std::int32_t, kLanes> begin;
  Pack<Abi> width, height;
};

namespace detail {

// base[at] of every lane of a part.
template <class Abi>
auto gather(const std::uint32_t* base, const typename Pack<Abi>::Ints& at) {
  using Ints = typename Pack<Abi>::Ints;
  const auto* ints = reinterpret_cast<const int*>(base);
#ifdef __AVX512F__
  if constexpr (Ints::size() == 16)
    return Ints(_mm512_i32gather_epi32(static_cast<__m512i>(at), ints, 4));
  else
#elif defined(__AVX2__)
  if constexpr (Ints::size() == 8)
    return Ints(_mm256_i32gather_epi32(ints, static_cast<__m256i>(at), 4));
  else
#endif
    return Ints([&](auto k) { return ints[at[k]]; });
}

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

template <class Part, class Ints>
Part byte_of(const Ints& words, int shift) {
  return stdx::static_simd_cast<Part>((words >> shift) & Ints(0xFF));
}

template <class T>
T lerp(const T& a, const T& b, const T& t) {
  return a + t * (b - a);
}

}  // namespace detail

// Correlation in [-1, 1], or kNoCorrelation as ZnccFunction gives it. The bounds are tested at the
// window's corners: the warp is affine, and rounding keeps the order of numbers.
template <class Abi>
Pack<Abi> lane_zncc(const ReferencePatch& patch, const std::uint32_t* words,
                    const LaneImages<Abi>& image, const refractive::Projection<Pack<Abi>>& centre,
                    const refractive::Matrix2<Pack<Abi>>& warp) {
  using T = Pack<Abi>;
  using Part = typename T::Part;
  using Ints = typename T::Ints;
  constexpr std::size_t kSide = 5;
  const T reach(static_cast<float>(kPatchRadius));
  const T extent_x = abs(warp(0, 0)) * reach + abs(warp(0, 1)) * reach;
  const T extent_y = abs(warp(1, 0)) * reach + abs(warp(1, 1)) * reach;
  const T& x = centre.pixel.x();
  const T& y = centre.pixel.y();
  const PackMask<Abi> inside = centre.visible && x - extent_x >= T(1) && y - extent_y >= T(1) &&
                               x + extent_x <= image.width - T(2) &&
                               y + extent_y <= image.height - T(2);

  T mean, square, cross;
  for (std::size_t p = 0; p < T::kCount; ++p) {
    const auto safe = [&](const T& value, float otherwise) {
      Part part = value.part[p];
      stdx::where(!inside.part[p], part) = Part(otherwise);
      return part;
    };
    const Part x0 = safe(x, 1), y0 = safe(y, 1);
    const Part xu = safe(warp(0, 0), 0), xv = safe(warp(0, 1), 0);
    const Part yu = safe(warp(1, 0), 0), yv = safe(warp(1, 1), 0);
    const Ints begin(image.begin.data() + p * T::kWidth, stdx::vector_aligned);
    const Ints stride = stdx::static_simd_cast<Ints>(image.width.part[p]);
    std::array<Part, kSide> column_x, column_y;
    for (std::size_t i = 0; i < kSide; ++i) {
      const Part offset(static_cast<float>(kPatchStep * static_cast<int>(i) - kPatchRadius));
      column_x[i] = x0 + xu * offset;
      column_y[i] = y0 + yu * offset;
    }
    Part sum(0.0f), sum_square(0.0f), sum_cross(0.0f);
    for (std::size_t j = 0; j < kSide; ++j) {
      const Part offset(static_cast<float>(kPatchStep * static_cast<int>(j) - kPatchRadius));
      const Part row_x = xv * offset, row_y = yv * offset;
      for (std::size_t i = 0; i < kSide; ++i) {
        const Part at_x = column_x[i] + row_x;
        const Part at_y = column_y[i] + row_y;
        const Ints column = stdx::static_simd_cast<Ints>(at_x);
        const Ints row = stdx::static_simd_cast<Ints>(at_y);
        const Part fx = at_x - stdx::static_simd_cast<Part>(column);
        const Part fy = at_y - stdx::static_simd_cast<Part>(row);
        const Ints word = detail::gather<Abi>(words, begin + row * stride + column);
        const Part top =
            detail::lerp(detail::byte_of<Part>(word, 0), detail::byte_of<Part>(word, 8), fx);
        const Part bottom =
            detail::lerp(detail::byte_of<Part>(word, 16), detail::byte_of<Part>(word, 24), fx);
        const Part value = detail::lerp(top, bottom, fy) - Part(patch.mean);
        const Part weighted = Part(patch.weight[j * kSide + i]) * value;
        sum += weighted;
        sum_square += weighted * value;
        sum_cross += Part(patch.deviation[j * kSide + i]) * value;
      }
    }
    mean.part[p] = sum;
    square.part[p] = sum_square;
    cross.part[p] = sum_cross;
  }
  const T variance = square - mean * mean;
  const PackMask<Abi> known = inside && variance > T(kFlatVariance) && T(patch.variance) > T(0);
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
  for (std::size_t p = 0; p < T::kCount; ++p) {
    Part px = x.part[p], py = y.part[p];
    stdx::where(!inside.part[p], px) = Part(0.0f);
    stdx::where(!inside.part[p], py) = Part(0.0f);
    const Ints begin(image.begin.data() + p * T::kWidth, stdx::vector_aligned);
    const Ints width = stdx::static_simd_cast<Ints>(image.width.part[p]);
    const Ints height = stdx::static_simd_cast<Ints>(image.height.part[p]);
    const Ints column = stdx::min(stdx::static_simd_cast<Ints>(px), width - 2);
    const Ints row = stdx::min(stdx::static_simd_cast<Ints>(py), height - 2);
    const Part fx = px - stdx::static_simd_cast<Part>(column);
    const Part fy = py - stdx::static_simd_cast<Part>(row);
    Part sum(0.0f), weights(0.0f);
    for (int dy = 0; dy < 2; ++dy) {
      for (int dx = 0; dx < 2; ++dx) {
        const Ints index = begin + (row + dy) * width + (column + dx);
        const Part value = detail::gather_floats<Abi>(depths, index);
        Part weight = (dx ? fx : Part(1.0f) - fx) * (dy ? fy : Part(1.0f) - fy) + Part(1e-6f);
        const auto near = stdx::abs(value - expected.part[p]) < kSameSurface * expected.part[p];
        stdx::where(!near, weight) = Part(0.0f);
        sum += weight * value;
        weights += weight;
      }
    }
    const auto some = weights > Part(0.0f);
    stdx::where(!some, weights) = Part(1.0f);
    Part depth = sum / weights;
    stdx::where(!some || !inside.part[p], depth) = Part(0.0f);
    found.part[p] = depth;
  }
  return found;
}

}  // namespace axial::depth::lanes
