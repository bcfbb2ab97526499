// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace axial {

// The bytes that the C library's heap uses for a block of `bytes`: the block and 8 bytes, rounded
// up to a multiple of 16, and at least 32. An empty block uses none.
inline std::uint64_t heap_bytes(std::uint64_t bytes) {
  if (bytes == 0) return 0;
  return std::max<std::uint64_t>(32, (bytes + 8 + 15) / 16 * 16);
}

}  // namespace axial
