// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace axial {

// Returns the number of bytes that the C library's heap (glibc, 64 bits) uses for a block of
// `bytes` bytes: `bytes` + 8, rounded up to a multiple of 16, but at least 32. An empty block
// counts as 0 bytes.
inline std::uint64_t heap_bytes(std::uint64_t bytes) {
  if (bytes == 0) return 0;
  return std::max<std::uint64_t>(32, (bytes + 8 + 15) / 16 * 16);
}

}  // namespace axial
