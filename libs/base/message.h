// SPDX-License-Identifier: GPL-3.0-or-later
// Text of any origin as one line of bounded length: what `fail` throws, `log_warning` writes and
// run_program prints, for they quote files.
#pragma once

#include <string>
#include <string_view>

namespace axial {

// Longest line, and longest part of it without a blank [bytes].
inline constexpr std::size_t kLongestMessage = 500;
inline constexpr std::size_t kLongestWord = 200;

// `text` in one line: control characters become blanks, and "..." takes the place of the middle of
// a word longer than kLongestWord and of a line longer than kLongestMessage. Characters of UTF-8
// are not cut into. A text that fits is returned as it is.
std::string as_message(std::string_view text);

}  // namespace axial
