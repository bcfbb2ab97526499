// SPDX-License-Identifier: GPL-3.0-or-later
// Reads numbers from words, independently of the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>

namespace axial {

// Returns the decimal number that the whole token represents, as std::from_chars reads it; a
// leading "+" is allowed, blanks are not. Empty if the token is not a number or if the number does
// not fit into T. For floating-point T, "inf" and "nan" are numbers.
template <class T>
std::optional<T> parse_number(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  T value{};
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return {};
  return value;
}

// Returns parse_number() of the token, but empty for infinities and NaN.
template <class T>
std::optional<T> parse_finite(std::string_view token) {
  const std::optional<T> value = parse_number<T>(token);
  if constexpr (std::is_floating_point_v<T>) {
    if (value && !std::isfinite(*value)) return {};
  }
  return value;
}

}  // namespace axial
