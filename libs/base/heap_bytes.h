// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace axial {

// What the C library's heap takes for a block of `bytes`: nothing for none, at least 32.
inline std::uint64_t heap_bytes(std::uint64_t bytes) {
  if (bytes == 0) return 0;
  return std::max<std::uint64_t>(32, (bytes + 8 + 15) / 16 * 16);
}

}  // namespace axial
