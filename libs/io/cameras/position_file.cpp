// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/position_file.h"

#include <array>
#include <optional>

#include "base/atomic_file.h"
#include "private/bytes/text_reader.h"

namespace axial::io {
namespace {

// Removes and returns the quoted text at the beginning of `text`; nothing if the quote is not
// closed.
std::optional<std::string> take_quoted(std::string_view& text) {
  std::string content;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '"') {
      if (i + 1 == text.size() || text[i + 1] != '"') {
        text.remove_prefix(i + 1);
        return content;
      }
      ++i;
    }
    content += text[i];
  }
  return {};
}

// Removes and returns the last blank-separated token.
std::string_view take_last_token(std::string_view& text) {
  text = trimmed(text);
  const std::size_t blank = text.find_last_of(kBlanks);
  const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
  const std::string_view token = text.substr(begin);
  text = trimmed(text.substr(0, begin));
  return token;
}

struct Reading {
  std::string_view name;
  std::array<std::string_view, 3> numbers;
};

// Reads NAME X Y Z; nothing if the text ends in fewer than three numbers or the name is empty.
std::optional<Reading> read_from_end(std::string_view text) {
  Reading reading;
  for (std::size_t i = 3; i-- > 0;) {
    reading.numbers[i] = take_last_token(text);
    if (!parse_number<double>(reading.numbers[i])) return {};
  }
  reading.name = text;
  if (text.empty()) return {};
  return reading;
}

// Positions where a comment may begin. The end of the text comes first, then the positions from
// right to left.
std::vector<std::size_t> possible_ends(std::string_view text) {
  std::vector<std::size_t> ends{text.size()};
  for (std::size_t i = text.size(); i-- > 0;)
    if (text[i] == '#' && (i == 0 || kBlanks.find(text[i - 1]) != std::string_view::npos))
      ends.push_back(i);
  return ends;
}

// Reads a line that can be understood in several ways. Prefers the way whose name is an image,
// otherwise the way with the longest comment.
std::optional<Reading> best_reading(std::string_view text, const IsImage& is_image) {
  std::optional<Reading> best;
  for (const std::size_t end : possible_ends(text)) {
    const auto reading = read_from_end(text.substr(0, end));
    if (reading && is_image(std::string(reading->name))) return reading;
    if (reading) best = reading;
  }
  return best;
}

Eigen::Vector3d position_of(const Reading& reading, const std::string& where) {
  Eigen::Vector3d position;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = parse_finite<double>(reading.numbers[i]);
    if (!value) fail("{}: '{}' is not finite", where, reading.numbers[i]);
    position[static_cast<Eigen::Index>(i)] = *value;
  }
  return position;
}

// Reads `"NAME" X Y Z` with an optional comment.
std::optional<NamedPosition> parse_quoted(std::string_view text, const std::string& where) {
  if (!text.starts_with('"')) return {};
  const auto name = take_quoted(text);
  if (!name) return {};
  text = text.substr(0, text.find('#'));
  const std::string with_name = "n " + std::string(text);
  const auto reading = read_from_end(with_name);
  if (!reading || reading->name != "n") return {};
  return NamedPosition{*name, position_of(*reading, where)};
}

bool is_comment(std::string_view text) {
  return text.empty() || text.starts_with('#');
}

std::optional<NamedPosition> parse(std::string_view text, const IsImage& is_image,
                                   const std::string& where) {
  const auto reading = best_reading(text, is_image);
  if (reading && is_image(std::string(reading->name)))
    return NamedPosition{std::string(reading->name), position_of(*reading, where), 0, true};
  if (is_comment(text)) return {};
  if (auto quoted = parse_quoted(text, where)) {
    quoted->known = is_image(quoted->name);
    return quoted;
  }
  if (!reading) fail("{}: must be NAME X Y Z", where);
  return NamedPosition{std::string(reading->name), position_of(*reading, where)};
}

}  // namespace

std::vector<NamedPosition> read_positions(const std::filesystem::path& file,
                                          const IsImage& is_image) {
  std::string text = read_file(file);
  if (!text.ends_with('\n')) text += '\n';
  TextReader reader(text, file.string());
  std::vector<NamedPosition> positions;
  int number = 0;
  while (const auto line = reader.line()) {
    const std::string where = fmt::format("{}:{}", file.string(), ++number);
    auto position = parse(line->rest(), is_image, where);
    if (!position) continue;
    position->line = number;
    positions.push_back(*std::move(position));
  }
  return positions;
}

std::vector<std::string> split_list(std::string_view text, const std::string& where) {
  std::vector<std::string> fields;
  while (true) {
    std::string field;
    if (text.starts_with('"')) {
      const auto quoted = take_quoted(text);
      if (!quoted) fail("{}: a quote is not closed", where);
      field = *quoted;
    }
    const std::size_t comma = std::min(text.find(','), text.size());
    field += text.substr(0, comma);
    fields.push_back(std::move(field));
    if (comma == text.size()) return fields;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace axial::io
