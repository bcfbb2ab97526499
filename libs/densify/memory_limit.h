// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/error.h"
#include "base/memory.h"
#include "densify/settings.h"

namespace axial::densify {

// The unit of Settings::max_memory [bytes].
inline constexpr std::uint64_t kMegabyte = 1'000'000;

// The memory [bytes] of the program itself: code and libraries, stacks, small blocks, and the
// portions of fusion.
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// The memory [bytes] that a run may use: Settings::max_memory, or 70 % of the available memory
// (available_memory() in base/memory.h) if max_memory is 0. Throws an Error if max_memory is 0 and
// the system does not tell how much memory is available.
inline std::uint64_t memory_limit(const Settings& settings) {
  if (settings.max_memory > 0) return settings.max_memory * kMegabyte;
  try {
    return available_memory() / 10 * 7;
  } catch (const Error& error) {
    fail("{}; give {}", error.what(), settings.name_of("max_memory"));
  }
}

}  // namespace axial::densify
