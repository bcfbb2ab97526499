// SPDX-License-Identifier: GPL-3.0-or-later
// Measured upper limits of this machine's speed, for comparison with the scorer.
#pragma once

#include <algorithm>

namespace axial::depth::lanes {
enum class InstructionSet;  // lanes/scorer.h
}

namespace axial::benchmarks {

// All values are the best since the program began: a disturbance only slows a measurement.

// Cycles per nanosecond, measured by a chain of additions that take one cycle each.
double clock_ghz();

// For one core and one instruction set, with data in the first-level cache.
struct MachineLimits {
  // 32-bit words from arbitrary places into a register, with the gather instruction (0: the set has
  // none) or loaded one by one.
  double gathered_words_per_ns = 0, loaded_words_per_ns = 0;
  double float_operations_per_ns = 0;  // multiplications and additions, not fused

  double words_per_ns() const { return std::max(gathered_words_per_ns, loaded_words_per_ns); }
};

MachineLimits machine_limits(depth::lanes::InstructionSet set);

namespace detail {  // one translation unit for each set of registers
MachineLimits scalar_limits();
MachineLimits baseline_limits();
MachineLimits avx2_limits();
MachineLimits avx512_limits();
}  // namespace detail

}  // namespace axial::benchmarks
