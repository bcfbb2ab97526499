// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

}  // namespace axial::benchmarks
