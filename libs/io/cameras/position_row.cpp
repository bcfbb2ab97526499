// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "bytes/private/text_reader.h"
#include "cameras/private/position_parts.h"

namespace axial::io {
namespace {

using Fields = std::vector<std::string>;

constexpr std::size_t kManyWords = 64;  // more words are no name

// Removes and returns the last blank-separated token.
std::string_view take_last_token(std::string_view& text) {
  text = trimmed(text);
  const std::size_t blank = text.find_last_of(kBlanks);
  const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
  const std::string_view token = text.substr(begin);
  text = trimmed(text.substr(0, begin));
  return token;
}

double finite(std::string_view field, const std::string& where) {
  const std::optional<double> value = number_in(field);
  if (!value) fail_in(where, "'{}' is not a number", field);
  if (!std::isfinite(*value)) fail_in(where, "'{}' is not finite", field);
  return *value;
}

std::optional<Eigen::Vector3d> sigma_of(double across, double up) {
  if (!(across > 0) || !(up > 0)) return {};
  return Eigen::Vector3d(across, across, up);
}

// The row of a name and the numbers behind it, in a file without a header. Its forms have three
// numbers, and then the accuracies, or three angles, or both; after both, anything may follow.
PositionRow row_of(std::string name, std::span<const std::string> fields,
                   const std::string& where) {
  PositionRow row;
  row.name = std::move(name);
  for (std::size_t i = 0; i < 3; ++i)
    row.position[static_cast<Eigen::Index>(i)] = finite(fields[i], where);
  if (fields.size() == 4 || fields.size() == 7)
    fail_in(where,
            "must be NAME X Y Z, but {} numbers follow the name; say what they are in a first line "
            "such as label,x,y,z,accuracy",
            fields.size());
  const std::size_t first = fields.size() == 5 ? 3 : fields.size() >= 8 ? 6 : 0;
  if (first == 0) return row;
  row.sigma = sigma_of(finite(fields[first], where), finite(fields[first + 1], where));
  row.sigma_guessed = row.sigma.has_value();
  return row;
}

// How many fields at the beginning are numbers.
std::size_t count_numbers(std::span<const std::string> fields) {
  std::size_t count = 0;
  while (count < fields.size() && number_in(fields[count])) ++count;
  return count;
}

// Whether the fields are at least three numbers and nothing else, except behind the eighth.
bool are_numbers(std::span<const std::string> fields) {
  const std::size_t count = count_numbers(fields);
  return count >= 8 || (count >= 3 && count == fields.size());
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

// NAME X Y Z, read from the end.
struct Reading {
  std::string_view name;
  std::array<std::string_view, 3> numbers;
};

// Nothing if the text ends in fewer than three numbers or the name is empty.
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

PositionRow row_of(const Reading& reading, const std::string& where) {
  const Fields fields(reading.numbers.begin(), reading.numbers.end());
  return row_of(std::string(reading.name), fields, where);
}

Fields words_of(std::string_view text) {
  Fields words;
  for (std::string_view word = take_token(text); !word.empty() && words.size() < kManyWords;
       word = take_token(text))
    words.emplace_back(word);
  return words;
}

// Reads the longest name that is an image from the beginning of the line; the numbers follow.
std::optional<PositionRow> read_from_start(std::string_view text, const IsImage& is_image,
                                           const std::string& where) {
  const std::string_view line = text.substr(0, possible_ends(text).back());
  for (std::size_t end = line.size(), words = 0; words < kManyWords; ++words) {
    end = line.find_last_of(kBlanks, end == 0 ? 0 : end - 1);
    if (end == std::string_view::npos || end == 0) return {};
    const std::string name(trimmed(line.substr(0, end)));
    const Fields fields = words_of(line.substr(end));
    if (are_numbers(fields) && is_image(name)) return row_of(name, fields, where);
  }
  return {};
}

// Reads `"NAME" X Y Z` with more numbers or a comment.
std::optional<PositionRow> read_quoted(std::string_view text, const std::string& where) {
  if (!text.starts_with('"')) return {};
  const auto name = take_quoted(text);
  if (!name || text.empty() || kBlanks.find(text.front()) == std::string_view::npos) return {};
  const Fields fields = words_of(text.substr(0, text.find('#')));
  if (!are_numbers(fields)) return {};
  return row_of(*name, fields, where);
}

bool all_empty(std::span<const std::string> fields) {
  return std::ranges::all_of(fields, &std::string::empty);
}

// Commas between fields and commas in numbers cannot be told apart.
void refuse_decimal_commas(const Fields& fields, const std::string& where) {
  const auto is_whole = [](const std::string& field) {
    return parse_number<long long>(field).has_value();
  };
  if (fields.size() == 7 && std::all_of(fields.begin() + 1, fields.end(), is_whole))
    fail_in(where,
            "commas separate the fields and may be decimal marks, too; separate the fields by "
            "semicolons");
}

// Reads NAME;X;Y;Z without a header.
std::optional<PositionRow> read_fields(std::string_view text, char delimiter,
                                       const std::string& where) {
  auto fields = split_fields(text, delimiter);
  while (fields && fields->size() > 4 && fields->back().empty()) fields->pop_back();
  if (!fields || fields->size() < 4 || fields->front().empty()) return {};
  const auto values = std::span(*fields).subspan(1);
  if (all_empty(values)) {
    PositionRow row;
    row.name = fields->front();
    row.without_position = true;
    return row;
  }
  if (!are_numbers(values)) return {};
  if (delimiter == ',') refuse_decimal_commas(*fields, where);
  return row_of(fields->front(), values, where);
}

// Prefers a delimiter with which the name is an image.
std::optional<PositionRow> read_delimited(std::string_view text, const PositionLayout& layout,
                                          const IsImage& is_image, const std::string& where) {
  std::optional<PositionRow> best;
  std::vector<std::size_t> ends = possible_ends(text);
  ends.resize(std::min(ends.size(), kManyWords));  // each end takes the time of the whole line
  for (const std::size_t end : ends)
    for (const char delimiter : {';', '\t', ','}) {
      if (layout.delimiter && delimiter != layout.delimiter) continue;
      auto row = read_fields(trimmed(text.substr(0, end)), delimiter, where);
      if (row && is_image(row->name)) return row;
      if (row && !best) best = row;
    }
  return best;
}

// The words of a line whose header separates columns by blanks; blanks may be in the name.
Fields words_by_header(std::string_view text, const std::vector<Column>& columns) {
  Fields words = words_of(text);
  const auto label =
      static_cast<std::size_t>(std::ranges::find(columns, Column::label) - columns.begin());
  while (words.size() > columns.size() && label + 1 < words.size()) {
    words[label] += " " + words[label + 1];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(label) + 1);
  }
  return words;
}

// The standard deviations in the columns; nothing if a field of them is empty or not above zero.
std::optional<Eigen::Vector3d> sigma_by_header(const Fields& fields,
                                               const std::vector<Column>& columns) {
  double across = 0, up = 0;
  for (std::size_t i = 0; i < columns.size() && i < fields.size(); ++i) {
    const double value = number_in(fields[i]).value_or(0);
    if (columns[i] == Column::sigma || columns[i] == Column::sigma_across)
      across = std::max(across, value);
    if (columns[i] == Column::sigma || columns[i] == Column::sigma_up) up = std::max(up, value);
  }
  if (!std::isfinite(across + up)) return {};
  return sigma_of(across, up > 0 ? up : across);
}

std::optional<PositionRow> row_by_header(const Fields& fields, const std::vector<Column>& columns,
                                         const std::string& where) {
  PositionRow row;
  std::array<std::string, 3> values;
  for (std::size_t i = 0; i < columns.size() && i < fields.size(); ++i) {
    if (columns[i] == Column::label) row.name = fields[i];
    if (columns[i] == Column::x) values[0] = fields[i];
    if (columns[i] == Column::y) values[1] = fields[i];
    if (columns[i] == Column::z || columns[i] == Column::depth) values[2] = fields[i];
    row.is_depth |= columns[i] == Column::depth;
  }
  if (row.name.empty()) return {};
  row.without_position = all_empty(values);
  if (row.without_position) return row;
  for (std::size_t i = 0; i < 3; ++i)
    row.position[static_cast<Eigen::Index>(i)] = finite(values[i], where);
  row.sigma = sigma_by_header(fields, columns);
  return row;
}

bool is_comment(std::string_view text) {
  return text.empty() || text.starts_with('#');
}

// A line whose columns are separated by blanks. Prefers a comment with which the name is an image,
// otherwise the longest comment.
std::optional<PositionRow> read_words_by_header(std::string_view text,
                                                const std::vector<Column>& columns,
                                                const IsImage& is_image, const std::string& where) {
  Fields found;
  std::vector<std::size_t> ends = possible_ends(text);
  ends.erase(ends.begin(),
             ends.end() - static_cast<std::ptrdiff_t>(std::min(ends.size(), kManyWords)));
  for (const std::size_t end : ends) {
    Fields words = words_by_header(text.substr(0, end), columns);
    if (words.size() != columns.size()) continue;
    found = std::move(words);
    const auto label = std::ranges::find(columns, Column::label) - columns.begin();
    if (is_image(found[static_cast<std::size_t>(label)])) break;
  }
  if (found.empty()) return {};
  return row_by_header(found, columns, where);
}

// A line of a file whose header names the columns.
std::optional<PositionRow> read_by_header(std::string_view text, const PositionLayout& layout,
                                          const IsImage& is_image, const std::string& where) {
  if (is_comment(text)) return {};
  if (layout.delimiter == 0) return read_words_by_header(text, layout.columns, is_image, where);
  auto fields = split_fields(text, layout.delimiter);
  if (!fields) fail_in(where, "a quote is not closed");
  while (fields->size() > layout.columns.size() && fields->back().empty()) fields->pop_back();
  if (fields->size() > layout.columns.size())
    fail_in(where, "has {} fields, but the header names {} columns", fields->size(),
            layout.columns.size());
  if (all_empty(*fields)) return {};
  auto row = row_by_header(*fields, layout.columns, where);
  if (!row) fail_in(where, "has no label");
  return row;
}

// IMAGE_ID, a quaternion, a translation, CAMERA_ID, NAME.
bool is_pose_of_colmap(std::string_view text) {
  const Fields words = words_of(text);
  if (words.size() < 10 || count_numbers(words) != 9) return false;
  double squares = 0;
  for (std::size_t i = 1; i < 5; ++i) {
    const double value = *number_in(words[i]);
    squares += value * value;
  }
  return std::abs(squares - 1) < 1e-3;
}

// Without an image of this name: the first word is the name if numbers alone follow.
PositionRow unknown_row(std::string_view text, const Reading& reading, const std::string& where) {
  std::string_view line =
      text.substr(0, static_cast<std::size_t>(reading.numbers[2].end() - text.begin()));
  const std::string name(take_token(line));
  const Fields fields = words_of(line);
  if (fields.size() > 3 && are_numbers(fields)) return row_of(name, fields, where);
  return row_of(reading, where);
}

std::optional<PositionRow> read_any(std::string_view text, const PositionLayout& layout,
                                    const IsImage& is_image, const std::string& where) {
  const auto reading = best_reading(text, is_image);
  if (reading && is_image(std::string(reading->name))) return row_of(*reading, where);
  if (is_comment(text)) return {};
  if (auto row = read_quoted(text, where)) return row;
  if (auto row = read_from_start(text, is_image, where)) return row;
  auto delimited = read_delimited(text, layout, is_image, where);
  if (delimited && (!reading || is_image(delimited->name))) return delimited;
  if (reading) return unknown_row(text, *reading, where);
  if (is_pose_of_colmap(text))
    fail_in(where,
            "is a line of COLMAP's images.txt, which has no camera centres; AlignModel takes a "
            "model as its reference");
  fail_in(where, "must be NAME X Y Z");
}

}  // namespace

std::optional<PositionRow> read_position_row(std::string_view text, const PositionLayout& layout,
                                             const IsImage& is_image, const std::string& where) {
  std::optional<PositionRow> row;
  if (!layout.columns.empty()) row = read_by_header(text, layout, is_image, where);
  if (!row && (layout.columns.empty() || layout.delimiter == 0))
    row = read_any(text, layout, is_image, where);
  if (row) row->known = is_image(row->name);
  return row;
}

}  // namespace axial::io
