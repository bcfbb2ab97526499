// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "densify/settings.h"

namespace axial::densify {

// The memory [bytes] that a run may use: MemoryAllowance::megabytes, or a part of the available
// memory (memory_limit() in base/memory.h). Throws an Error if `megabytes` is 0 and the system does
// not tell how much memory is available.
inline std::uint64_t memory_limit(const Settings& settings) {
  return axial::memory_limit(settings.survey.memory.megabytes, settings.name_of("max_memory"));
}

}  // namespace axial::densify
