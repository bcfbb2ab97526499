// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/machine_limits.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>

#include "depth/lanes/scorer.h"

namespace axial::benchmarks {

double clock_ghz() {
  constexpr int kRounds = 20000, kAdditions = 10;
  static double best = 0;
  for (int run = 0; run < 25; ++run) {
    std::uint64_t sum = 1;
    const std::uint64_t term = 3;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kRounds; ++i)
      // Adds registers: the processor may eliminate additions of constants.
      asm volatile(
          "add %1, %0\n add %1, %0\n add %1, %0\n add %1, %0\n add %1, %0\n"
          "add %1, %0\n add %1, %0\n add %1, %0\n add %1, %0\n add %1, %0\n"
          : "+r"(sum)
          : "r"(term));
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    best = std::max(best, kRounds * kAdditions / spent.count());
  }
  return best;
}

namespace {

MachineLimits measured_limits(depth::lanes::InstructionSet set) {
  using depth::lanes::InstructionSet;
  switch (set) {
    case InstructionSet::scalar:
      return detail::scalar_limits();
    case InstructionSet::baseline:
      return detail::baseline_limits();
    case InstructionSet::avx2:
      return detail::avx2_limits();
    case InstructionSet::avx512:
      return detail::avx512_limits();
  }
  return {};
}

}  // namespace

MachineLimits machine_limits(depth::lanes::InstructionSet set) {
  static std::map<depth::lanes::InstructionSet, MachineLimits> kept;
  MachineLimits& best = kept[set];
  const MachineLimits now = measured_limits(set);
  best.gathered_words_per_ns = std::max(best.gathered_words_per_ns, now.gathered_words_per_ns);
  best.loaded_words_per_ns = std::max(best.loaded_words_per_ns, now.loaded_words_per_ns);
  best.float_operations_per_ns =
      std::max(best.float_operations_per_ns, now.float_operations_per_ns);
  return best;
}

}  // namespace axial::benchmarks
