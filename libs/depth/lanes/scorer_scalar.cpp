// SPDX-License-Identifier: GPL-3.0-or-later
// The reference for tests: one float at a time.
#include "depth/lanes/lane_scorer.h"

namespace axial::depth::lanes::detail {

std::unique_ptr<Scorer> make_scalar_scorer(const SceneTables& tables) {
  return make_lane_scorer<stdx::simd_abi::scalar>(tables);
}

}  // namespace axial::depth::lanes::detail
