// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/message.h"

#include <algorithm>

namespace axial {
namespace {

constexpr std::string_view kGap = "...";
// For the gap in a line. Without blanks the gap would join two words into a word that is too long.
constexpr std::string_view kGapOfWords = " ... ";

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

bool is_control(char byte) {
  return static_cast<unsigned char>(byte) < 0x20 || byte == 0x7F;
}

// Returns the beginning and the end of `text` with `gap` between them, at most `longest` bytes.
std::string without_middle(std::string_view text, std::size_t longest, std::string_view gap) {
  if (text.size() <= longest) return std::string(text);
  std::size_t head = (longest - gap.size() + 1) / 2;
  std::size_t tail = text.size() - (longest - gap.size()) / 2;
  // At most 3 steps: a UTF-8 character has at most 3 continuation bytes, but in other text such
  // bytes may follow each other without end.
  for (int i = 0; i < 3 && continues_character(text[head]); ++i) --head;
  for (int i = 0; i < 3 && tail < text.size() && continues_character(text[tail]); ++i) ++tail;
  return std::string(text.substr(0, head)).append(gap).append(text.substr(tail));
}

}  // namespace

std::string as_message(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(line, is_control, ' ');
  std::string result;
  for (std::string_view rest = line; !rest.empty();) {
    const std::size_t blank = rest.find(' ');
    result += without_middle(rest.substr(0, blank), kLongestWord, kGap);
    if (blank == std::string_view::npos) break;
    result += ' ';
    rest.remove_prefix(blank + 1);
  }
  return without_middle(result, kLongestMessage, kGapOfWords);
}

}  // namespace axial
