// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include "base/message.h"

namespace axial {
namespace {

// The marks before and after a setting: control characters, which as_message() removes.
constexpr char kBegin = '\x0E', kEnd = '\x0F';

// The position after the setting that begins at `begin`. npos: no setting begins there.
std::size_t end_of_setting(std::string_view text, std::size_t begin) {
  const std::size_t end = text.find_first_of("\x0E\x0F", begin + 1);
  return end == std::string_view::npos || text[end] != kEnd ? std::string_view::npos : end + 1;
}

}  // namespace

std::string setting(std::string_view name) {
  return std::string(1, kBegin).append(name) + kEnd;
}

std::string in_words(std::string_view text, const SettingNames& names) {
  std::string words;
  for (std::size_t at = text.find(kBegin); at != std::string_view::npos; at = text.find(kBegin)) {
    words += text.substr(0, at);
    const std::size_t end = end_of_setting(text, at);
    if (end == std::string_view::npos) {
      text.remove_prefix(at + 1);  // the mark is a control character of the user's text
      continue;
    }
    const std::string_view name = text.substr(at + 1, end - at - 2);
    const auto known = names.find(name);
    words += known == names.end() ? name : known->second;
    text.remove_prefix(end);
  }
  words += text;
  std::erase(words, kEnd);
  return words;
}

struct Error::Parts {
  std::string text;
  std::filesystem::path file;
};

Error::Error(const std::string& text, const std::filesystem::path& file)
    : std::runtime_error(as_message(in_words(text))),
      parts_(std::make_shared<const Parts>(Parts{text, file})) {}

const std::string& Error::text() const {
  return parts_->text;
}

const std::filesystem::path& Error::file() const {
  return parts_->file;
}

std::string Error::setting() const {
  const std::string_view text = parts_->text;
  if (!text.starts_with(kBegin)) return {};
  const std::size_t end = end_of_setting(text, 0);
  return end == std::string_view::npos ? "" : std::string(text.substr(1, end - 2));
}

void fail_formatted(fmt::string_view format, fmt::format_args arguments) {
  throw Error(fmt::vformat(format, arguments));
}

void fail_formatted_in(const std::filesystem::path& file, fmt::string_view format,
                       fmt::format_args arguments) {
  throw Error(file.string() + ": " + fmt::vformat(format, arguments), file);
}

std::string marked_text(const std::exception& error) {
  const auto* ours = dynamic_cast<const Error*>(&error);
  return ours ? ours->text() : error.what();
}

}  // namespace axial
