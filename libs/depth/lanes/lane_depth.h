// SPDX-License-Identifier: GPL-3.0-or-later
// Reads depths near an expected depth from depth maps, with one source view per SIMD lane.
#pragma once

#include "depth/consistency.h"
#include "depth/lanes/lane_images.h"
#include "depth/patch/reference_patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth::lanes {

namespace detail {

// base[at] for each lane.
template <class Abi>
auto gather_floats(const float* base, const typename Pack<Abi>::Ints& at) {
  using Part = typename Pack<Abi>::Part;
#ifdef __AVX512F__
  if constexpr (Part::size() == 16)
    return Part(_mm512_i32gather_ps(static_cast<__m512i>(at), base, 4));
  else
#endif
#ifdef __AVX2__
      if constexpr (Part::size() == 8)
    return Part(_mm256_i32gather_ps(base, static_cast<__m256i>(at), 4));
  else
#endif
    return Part([&](auto k) { return base[at[k]]; });
}

}  // namespace detail

// depth_near() of geometric_check.h in SIMD lanes, with the tolerance kSameSurface. `depths`: the
// depth maps of all views [m], row-major, one after the other. `image`: where each lane's map
// begins in `depths`, and the size of the map, at least 2x2 pixels. `at`: the position in each
// lane's map [px]. `expected`: the expected depths [m]. Returns the depth [m] of each lane, or 0 if
// no pixel around the position has a depth near the expected depth, or if the position is outside
// the map or not visible.
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
  px = blend(inside.part, px, Part(0.0f));
  py = blend(inside.part, py, Part(0.0f));
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
      weight = blend(near, weight, Part(0.0f));
      sum += weight * value;
      weights += weight;
    }
  }
  const auto some = weights > Part(0.0f);
  weights = blend(some, weights, Part(1.0f));
  Part depth = sum / weights;
  depth = blend(some && inside.part, depth, Part(0.0f));
  found.part = depth;
  return found;
}

}  // namespace axial::depth::lanes
