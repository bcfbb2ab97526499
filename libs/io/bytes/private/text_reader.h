// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads the lines and tokens of text files.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "bytes/private/only_for_io.h"

namespace axial::io {

// Removes the first blank-separated token of `text` and returns it; empty if there is no token.
inline std::string_view take_token(std::string_view& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    text = {};
    return {};
  }
  const std::size_t end = std::min(text.find_first_of(kBlanks, first), text.size());
  const std::string_view token = text.substr(first, end - first);
  text.remove_prefix(end);
  return token;
}

// One line of a text file, read token by token from left to right.
class TextLine {
 public:
  TextLine(std::string_view text, const std::string& file, std::size_t number)
      : text_(text), file_(&file), number_(number) {}

  bool empty() const { return trimmed(text_).empty(); }
  std::string where() const { return fmt::format("{}: line {}", *file_, number_); }

  std::string_view word(std::string_view field) {
    const std::string_view token = take_token(text_);
    if (token.empty()) fail_in(where(), "{} is missing", field);
    return token;
  }

  template <class T>
  T number(std::string_view field) {
    const std::string_view token = word(field);
    const std::optional<T> value = parse_finite<T>(token);
    if (!value) fail_in(where(), "{} is '{}', which is not a valid number", field, token);
    return *value;
  }

  // The same line after its first `sign`. Precondition: the part that is not read yet contains it.
  TextLine after(char sign) const {
    TextLine later = *this;
    later.text_.remove_prefix(text_.find(sign) + 1);
    return later;
  }

  // The part that is not read yet, without blanks around it.
  std::string_view rest() const { return trimmed(text_); }

  // The same as the name of a file. Error for a NUL byte, at which the system would end the name.
  std::string_view file_name() const {
    if (text_.find('\0') != std::string_view::npos)
      fail_in(where(), "the name of a file contains a NUL byte");
    return rest();
  }

 private:
  std::string_view text_;
  const std::string* file_;
  std::size_t number_;
};

// Reads the lines of a text file. A byte order mark at its beginning is skipped. The last line must
// end with a newline; otherwise line() gives an Error, because the file was probably truncated.
class TextReader {
 public:
  TextReader(std::string_view text, std::string file)
      : text_(without_byte_order_mark(text)), size_(text.size()), file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  // Byte offset of the next line.
  std::size_t position() const { return size_ - text_.size(); }

  // Returns the next line, including comments and empty lines; nothing at the end of the file.
  std::optional<TextLine> line() {
    if (text_.empty()) return {};
    ++number_;
    const std::size_t end = text_.find('\n');
    if (end == std::string_view::npos)
      fail_in(file_, "line {} has no end: the file is truncated", number_);
    const TextLine next(text_.substr(0, end), file_, number_);
    text_.remove_prefix(end + 1);
    return next;
  }

  // Returns the next line that is neither empty nor a '#' comment; nothing at the end of the file.
  std::optional<TextLine> record() {
    while (std::optional<TextLine> next = line())
      if (!next->empty() && next->rest().front() != '#') return next;
    return {};
  }

 private:
  std::string_view text_;
  std::size_t size_;
  std::string file_;
  std::size_t number_ = 0;
};

}  // namespace axial::io
