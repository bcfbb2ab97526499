// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/table_text.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "base/atomic_file.h"
#include "base/file_extension.h"
#include "base/split.h"
#include "bytes/private/text_reader.h"

namespace axial::io {
namespace {

using Words = std::initializer_list<std::string_view>;

bool has(Words words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_longitude(std::string_view word) {
  return has({"longitude", "lon", "long", "lng", "gps longitude", "gpslongitude"}, word);
}

bool is_latitude(std::string_view word) {
  return has({"latitude", "lat", "gps latitude", "gpslatitude"}, word);
}

Column coordinate(std::string_view word) {
  if (is_longitude(word) ||
      has({"x", "easting", "east", "e", "geo x", "pos x", "coordinate1"}, word))
    return Column::x;
  if (is_latitude(word) ||
      has({"y", "northing", "north", "n", "geo y", "pos y", "coordinate2"}, word))
    return Column::y;
  if (has({"z", "altitude", "alt", "height", "elevation", "h", "up", "geo z", "pos z", "rl",
           "gps altitude", "gpsaltitude"},
          word))
    return Column::z;
  if (has({"depth"}, word)) return Column::depth;
  return Column::other;
}

// A column such as "accuracy z" or "accuracy horz". Metashape's "x error" is a residual.
Column accuracy(std::string_view words) {
  std::string text(words);
  std::ranges::replace(text, '/', ' ');
  bool across = false, up = false;
  std::string_view rest = text;
  for (std::string_view word = take_token(rest); !word.empty(); word = take_token(rest)) {
    const Column axis = coordinate(word);
    if (axis == Column::x || axis == Column::y || has({"xy", "horz", "horizontal", "h"}, word))
      across = true;
    else if (axis == Column::z || has({"vert", "vertical", "v"}, word))
      up = true;
  }
  if (across == up) return Column::sigma;
  return across ? Column::sigma_across : Column::sigma_up;
}

}  // namespace

std::string read_table_text(const std::filesystem::path& file) {
  std::string text = read_file(file);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    fail_in(file, "is UTF-16; save it as UTF-8");
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

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

std::optional<std::vector<std::string>> split_fields(std::string_view text, char delimiter) {
  std::vector<std::string> fields;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const bool end = i == text.size();
    if (end || (!quoted && text[i] == delimiter)) {
      if (quoted) return {};
      fields.emplace_back(trimmed(field));
      field.clear();
    } else if (text[i] != '"' || (!quoted && !trimmed(field).empty())) {
      field += text[i];
    } else if (quoted && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[i++];
    } else {
      quoted = !quoted;
    }
  }
  return fields;
}

std::optional<double> number_in(std::string_view field) {
  if (const auto value = parse_number<double>(field)) return value;
  std::string text(field);
  if (std::ranges::count(text, ',') != 1 || text.find('.') != std::string::npos) return {};
  std::ranges::replace(text, ',', '.');
  return parse_number<double>(text);
}

ColumnName column_name(std::string_view field) {
  ColumnName name;
  std::string text = lower_case(std::string(field));
  const std::size_t open = text.find_first_of("([");
  if (open != std::string::npos) {
    const std::size_t close = std::min(text.find_first_of(")]", open), text.size());
    name.unit = trimmed(std::string_view(text).substr(open + 1, close - open - 1));
    text = text.substr(0, open) + (close < text.size() ? text.substr(close + 1) : "");
  }
  for (char& c : text)
    if (c == '_' || c == '-' || c == '.' || c == '"' || c == '#') c = ' ';
  std::string_view rest = text;
  for (std::string_view word = take_token(rest); !word.empty(); word = take_token(rest))
    name.words += (name.words.empty() ? "" : " ") + std::string(word);
  return name;
}

Column column_of(const std::string& words) {
  if (has({"label", "name", "image", "image name", "imagename", "filename", "file name", "file",
           "photo", "photo name", "camera", "camera label", "picture", "sourcefile"},
          words))
    return Column::label;
  for (const char* word : {"accuracy", "sigma", "std", "acc "})
    if (words.find(word) != std::string::npos)
      return words.find("yaw") != std::string::npos || words.find("deg") != std::string::npos
                 ? Column::other
                 : accuracy(words);
  for (const std::string_view part : split(words, '/'))
    if (const Column column = coordinate(trimmed(part)); column != Column::other) return column;
  return Column::other;
}

bool means_degrees(const ColumnName& name) {
  return is_longitude(name.words) || is_latitude(name.words) || name.unit.starts_with("deg") ||
         name.unit == "decimal degrees" || name.unit == "°";
}

bool names_degrees(const std::string& words) {
  return std::ranges::any_of(split(words, '/'), [](std::string_view part) {
    return is_longitude(trimmed(part)) || is_latitude(trimmed(part));
  });
}

bool is_metre(std::string_view word) {
  return has({"m", "metre", "metres", "meter", "meters"}, word);
}

bool means_metres(const ColumnName& name) {
  return is_metre(name.unit);
}

bool is_known_unit(const std::string& unit) {
  return is_metre(unit) || has({"", "°", "decimal degrees"}, unit) || unit.starts_with("deg");
}

}  // namespace axial::io
