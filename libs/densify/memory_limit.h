// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "densify/settings.h"

namespace axial::densify {

// The memory [bytes] of the program itself: code and libraries, stacks, small blocks, and the
// portions of fusion.
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// The memory [bytes] that a run may use (base/memory.h).
inline std::uint64_t memory_limit(const Settings& settings) {
  return axial::memory_limit(settings.max_memory, settings.name_of("max_memory"));
}

}  // namespace axial::densify
