// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for AVX-512. No function defined here may be shared with other translation units.
#include "depth/lanes/lane_scorer.h"

namespace axial::depth::lanes::detail {

std::unique_ptr<Scorer> make_avx512_scorer(const SceneTables& tables) {
  using Wide = stdx::simd_abi::native<float>;
  using Narrow = stdx::simd_abi::deduce_t<float, 8>;
  static_assert(Pack<Wide>::kWidth == 16 && Pack<Narrow>::kWidth == 8);
  return make_lane_scorer<Narrow, Wide>(tables);
}

}  // namespace axial::depth::lanes::detail
