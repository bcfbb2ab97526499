// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "densify/settings.h"

namespace axial::densify {

inline constexpr std::uint64_t kMegabyte = 1000 * 1000;

// The program with its libraries, stacks, small blocks, and the portions of fusion [bytes].
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// The memory that a run may use [bytes].
inline std::uint64_t memory_limit(const Settings& settings) {
  return settings.max_memory > 0 ? settings.max_memory * kMegabyte : available_memory() / 10 * 7;
}

}  // namespace axial::densify
