// SPDX-License-Identifier: GPL-3.0-or-later
// Turns any text into one line of bounded length. Errors, warnings and run_program() use
// as_message(), because their messages quote the contents of files.
#pragma once

#include <string>
#include <string_view>

namespace axial {

// The longest line and the longest word of a message [bytes]. Words are separated by blanks.
inline constexpr std::size_t kLongestMessage = 500;
inline constexpr std::size_t kLongestWord = 200;

// Returns `text` as one line of at most kLongestMessage bytes. Each control character, such as a
// newline, becomes a blank. In a word longer than kLongestWord, and then in a line longer than
// kLongestMessage, "..." replaces the middle. UTF-8 characters are not split. A text that breaks no
// limit and has no control characters is returned unchanged.
std::string as_message(std::string_view text);

}  // namespace axial
