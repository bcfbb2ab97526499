// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace axial {

// The byte order mark. Some editors put these bytes before the first character of a UTF-8 file.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Returns `text` without the byte order mark at its start. A text without the mark is returned
// unchanged. The result refers to the characters of `text`.
inline std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

}  // namespace axial
