// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/error.h"
#include "base/memory.h"
#include "densify/settings.h"

namespace axial::densify {

inline constexpr std::uint64_t kMegabyte = 1'000'000;

// The program with its libraries, stacks, small blocks, and the portions of fusion [bytes].
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// The memory that a run may use [bytes]. Error if the settings do not name it and the system does
// not tell how much memory is free.
inline std::uint64_t memory_limit(const Settings& settings) {
  if (settings.max_memory > 0) return settings.max_memory * kMegabyte;
  try {
    return available_memory() / 10 * 7;
  } catch (const Error& error) {
    fail("{}; give {}", error.what(), settings.name_of("max_memory"));
  }
}

}  // namespace axial::densify
