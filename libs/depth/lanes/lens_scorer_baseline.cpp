// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for the baseline processor of the build.
#include "depth/lanes/lane_lens_scorer.h"

namespace axial::depth::lanes::detail {

std::unique_ptr<Scorer> make_baseline_lens_scorer(const SceneTables& tables) {
  return make_lane_lens_scorer<stdx::simd_abi::native<float>>(tables);
}

}  // namespace axial::depth::lanes::detail
