// SPDX-License-Identifier: GPL-3.0-or-later
// Append numbers to bytes, the lowest byte first.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace axial::view {

inline void append_u16(std::string& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<char>(value & 255u));
  bytes.push_back(static_cast<char>(value >> 8));
}

inline void append_u32(std::string& bytes, std::uint32_t value) {
  append_u16(bytes, static_cast<std::uint16_t>(value & 0xFFFFu));
  append_u16(bytes, static_cast<std::uint16_t>(value >> 16));
}

inline void append_f32(std::string& bytes, float value) {
  append_u32(bytes, std::bit_cast<std::uint32_t>(value));
}

}  // namespace axial::view
