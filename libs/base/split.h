// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

namespace axial {

// Returns the words of `text`, which are separated by `separator`. With the separator ',' the text
// "1,2," has the words "1", "2" and "". An empty text has no words. The words are views into the
// characters of `text`, which must exist as long as the words.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> words;
  if (text.empty()) return words;
  for (std::size_t end; (end = text.find(separator)) != std::string_view::npos;) {
    words.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  words.push_back(text);
  return words;
}

inline constexpr std::string_view kBlanks = " \t\r\n\v\f";

// `text` without the blanks at its beginning and end.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace axial
