// SPDX-License-Identifier: GPL-3.0-or-later
// What this machine can do at most, measured: the roofs that the scorer is held against.
#pragma once

#include <algorithm>

namespace axial::depth::lanes {
enum class InstructionSet;  // lanes/scorer.h
}

namespace axial::benchmarks {

// All of these are the best seen since the program began: what disturbs a measurement only slows
// it.

// Cycles per nanosecond, from a chain of additions, one cycle each.
double clock_ghz();

// Of one core, with one instruction set, data in the first-level cache.
struct MachineLimits {
  // 32-bit words from anywhere into a register: with the instruction for it (0: the set has none),
  // or loaded one by one.
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
