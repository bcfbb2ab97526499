// SPDX-License-Identifier: GPL-3.0-or-later
// Turns text of any origin into one line of bounded length. fail(), log_warning() and run_program()
// use it, because their messages quote file contents.
#pragma once

#include <string>
#include <string_view>

namespace axial {

// Longest line, and longest word in it [bytes]. Words are separated by blanks.
inline constexpr std::size_t kLongestMessage = 500;
inline constexpr std::size_t kLongestWord = 200;

// Returns `text` as one line. Control characters become blanks. In a word longer than kLongestWord
// and in a line longer than kLongestMessage, "..." replaces the middle. UTF-8 characters are not
// split. A short text without control characters is returned unchanged.
std::string as_message(std::string_view text);

}  // namespace axial
