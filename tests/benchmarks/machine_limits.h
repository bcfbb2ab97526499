// SPDX-License-Identifier: GPL-3.0-or-later
// Measured upper limits of this machine's speed, for comparison with the scorer.
#pragma once

#include <algorithm>

namespace axial::depth::lanes {
enum class InstructionSet;  // lanes/scorer.h
}

namespace axial::benchmarks {

// Every value is the best of all measurements since the program began, because disturbances can
// only slow a measurement.

// The clock rate of the processor [GHz], measured by a chain of additions that take one cycle each.
double clock_ghz();

// The limits of one core with one instruction set, for data in the first-level cache.
struct MachineLimits {
  // The number of 32-bit words that are read from arbitrary places into a vector register per
  // nanosecond: with the gather instruction (0: the instruction set has none), and loaded one by
  // one.
  double gathered_words_per_ns = 0, loaded_words_per_ns = 0;
  double float_operations_per_ns = 0;  // multiplications and additions, not fused

  double words_per_ns() const { return std::max(gathered_words_per_ns, loaded_words_per_ns); }
};

MachineLimits machine_limits(depth::lanes::InstructionSet set);

namespace detail {  // each function has its own translation unit
MachineLimits scalar_limits();
MachineLimits baseline_limits();
MachineLimits avx2_limits();
MachineLimits avx512_limits();
}  // namespace detail

}  // namespace axial::benchmarks
