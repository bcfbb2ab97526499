// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/ring_codes.h"

#include <algorithm>
#include <bit>

namespace axial::targets {

std::uint32_t smallest_rotation(std::uint32_t value, int bits) {
  const std::uint32_t all = (1u << bits) - 1;
  std::uint32_t smallest = value & all, turned = smallest;
  for (int i = 1; i < bits; ++i) {
    turned = ((turned << 1) | (turned >> (bits - 1))) & all;
    smallest = std::min(smallest, turned);
  }
  return smallest;
}

std::vector<std::uint32_t> ring_codes(int bits) {
  std::vector<std::uint32_t> codes;
  const std::uint32_t half = (1u << (bits / 2)) - 1;
  for (std::uint32_t value = 1; value < (1u << bits) - 1; value += 2) {
    const bool even = std::popcount(value) % 2 == 0;
    const bool opposite = (value & (value >> (bits / 2)) & half) != 0;
    if (even && opposite && smallest_rotation(value, bits) == value) codes.push_back(value);
  }
  return codes;
}

std::optional<std::size_t> ring_number(std::uint32_t value, int bits,
                                       std::span<const std::uint32_t> codes) {
  const std::uint32_t code = smallest_rotation(value, bits);
  const auto place = std::ranges::lower_bound(codes, code);
  if (place == codes.end() || *place != code) return std::nullopt;
  return static_cast<std::size_t>(place - codes.begin()) + 1;
}

}  // namespace axial::targets
