// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for AVX2. No function defined here may be shared with other translation units.
#include "depth/lanes/lane_scorer.h"

namespace axial::depth::lanes::detail {

std::unique_ptr<Scorer> make_avx2_scorer(const SceneTables& tables) {
  return make_lane_scorer<stdx::simd_abi::native<float>>(tables);
}

}  // namespace axial::depth::lanes::detail
