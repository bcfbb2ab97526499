// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: tables as text.
#pragma once

#include <string>

namespace axial::map {

// RFC 4180: quotes around a text with a comma, a quote or a line break.
inline std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace axial::map
