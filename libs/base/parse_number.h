// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers from words, independent of the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>

namespace axial {

// The whole token as a number; nothing if it is none or does not fit.
template <class T>
std::optional<T> parse_number(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  T value{};
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return {};
  return value;
}

// The same, and nothing for infinities and NaN.
template <class T>
std::optional<T> parse_finite(std::string_view token) {
  const std::optional<T> value = parse_number<T>(token);
  if constexpr (std::is_floating_point_v<T>) {
    if (value && !std::isfinite(*value)) return {};
  }
  return value;
}

}  // namespace axial
