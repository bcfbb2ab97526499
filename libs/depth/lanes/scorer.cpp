// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/lanes/scorer.h"

namespace axial::depth::lanes {

Scorer::~Scorer() = default;

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::scalar, InstructionSet::baseline};
#ifdef AXIAL_WIDE_LANES
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

InstructionSet fastest_instruction_set() {
  return available_instruction_sets().back();
}

std::unique_ptr<Scorer> make_scorer(const SceneTables& tables, InstructionSet set) {
  const bool straight = tables.kind < CameraKind::lens_pinhole;
  switch (set) {
    case InstructionSet::scalar:
      return straight ? detail::make_scalar_scorer(tables)
                      : detail::make_scalar_lens_scorer(tables);
    case InstructionSet::baseline:
      return straight ? detail::make_baseline_scorer(tables)
                      : detail::make_baseline_lens_scorer(tables);
#ifdef AXIAL_WIDE_LANES
    case InstructionSet::avx2:
      return straight ? detail::make_avx2_scorer(tables) : detail::make_avx2_lens_scorer(tables);
    case InstructionSet::avx512:
      return straight ? detail::make_avx512_scorer(tables)
                      : detail::make_avx512_lens_scorer(tables);
#endif
    default:
      return nullptr;
  }
}

}  // namespace axial::depth::lanes
