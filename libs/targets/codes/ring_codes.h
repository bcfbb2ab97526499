// SPDX-License-Identifier: GPL-3.0-or-later
// The codes of circular targets (Schneider 1991). The ring around the dot has n segments, one bit
// each: white is 1. A ring may be read from any segment, so all rotations of a code are the same
// code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace axial::targets {

// Returns the smallest value of all rotations of the `bits` lowest bits of `value`. `bits`: 1
// to 31.
std::uint32_t smallest_rotation(std::uint32_t value, int bits);

// Returns the valid codes of `bits` bits (8 to 20, even) in increasing order. A code is the
// smallest of its rotations, has an even number of ones, at least one zero, and at least one pair
// of opposite segments that are both 1. The number of a target is the position of its code in this
// list, counted from 1. Lists of other programs may have other numbers.
std::vector<std::uint32_t> ring_codes(int bits);

// Returns the number (from 1) of the target whose ring reads `value`, begun at any segment. Nothing
// if no code of `codes` has this ring. `codes`: a result of ring_codes(bits).
std::optional<std::size_t> ring_number(std::uint32_t value, int bits,
                                       std::span<const std::uint32_t> codes);

}  // namespace axial::targets
