// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "depth/lanes/scorer.h"

namespace axial::benchmarks {

inline const char* name_of(depth::lanes::InstructionSet set) {
  using depth::lanes::InstructionSet;
  switch (set) {
    case InstructionSet::scalar:
      return "scalar";
    case InstructionSet::baseline:
      return "baseline";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return "unknown";
}

inline bool available(depth::lanes::InstructionSet set) {
  const auto sets = depth::lanes::available_instruction_sets();
  return std::find(sets.begin(), sets.end(), set) != sets.end();
}

}  // namespace axial::benchmarks
