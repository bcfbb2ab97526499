// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <initializer_list>

#include "base/file_extension.h"
#include "base/split.h"
#include "bytes/private/text_reader.h"
#include "cameras/private/position_parts.h"

namespace axial::io {
namespace {

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_plane(Column column) {
  return column == Column::x || column == Column::y;
}

bool is_coordinate(Column column) {
  return is_plane(column) || column == Column::z || column == Column::depth;
}

// Clears all columns after the first of each kind.
void keep_first(std::vector<Column>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto end = columns.begin() + static_cast<std::ptrdiff_t>(i);
    const bool second_height =
        (columns[i] == Column::z && std::find(columns.begin(), end, Column::depth) != end) ||
        (columns[i] == Column::depth && std::find(columns.begin(), end, Column::z) != end);
    const bool again =
        columns[i] != Column::sigma_across && std::find(columns.begin(), end, columns[i]) != end;
    if (second_height || again) columns[i] = Column::other;
  }
}

bool has_column(const std::vector<Column>& columns, Column column) {
  return std::ranges::find(columns, column) != columns.end();
}

// The columns of a header line; nothing if the fields are none.
std::optional<std::vector<Column>> columns_of(const std::vector<ColumnName>& names) {
  std::vector<Column> columns;
  for (const ColumnName& name : names) {
    if (parse_number<double>(name.words)) return {};
    columns.push_back(column_of(name.words));
  }
  keep_first(columns);
  if (!has_column(columns, Column::label) && !columns.empty() && columns[0] == Column::other)
    columns[0] = Column::label;
  for (const Column needed : {Column::label, Column::x, Column::y})
    if (!has_column(columns, needed)) return {};
  if (!has_column(columns, Column::z) && !has_column(columns, Column::depth)) return {};
  return columns;
}

std::vector<ColumnName> column_names(std::string_view text, char delimiter) {
  std::vector<ColumnName> names;
  if (delimiter) {
    const auto fields = split_fields(text, delimiter);
    if (fields)
      for (const std::string& field : *fields) names.push_back(column_name(field));
    return names;
  }
  for (std::string_view word = take_token(text); !word.empty(); word = take_token(text))
    names.push_back(column_name(word));
  return names;
}

// Several delimiters may occur, as in "Label,X (m),Y (m)": the first that gives a header counts.
bool read_header(std::string_view text, const std::string& where, PositionLayout& layout) {
  while (text.starts_with('#') || text.starts_with('/')) text = trimmed(text.substr(1));
  for (const char delimiter : {';', '\t', ',', '\0'}) {
    if (layout.delimiter && delimiter != layout.delimiter) continue;
    const std::vector<ColumnName> names = column_names(text, delimiter);
    auto columns = columns_of(names);
    if (!columns) continue;
    bool degrees = false, metres = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!is_coordinate((*columns)[i])) continue;
      if (!is_known_unit(names[i].unit))
        fail_in(where, "column '{}' is in '{}', but positions must be in metres", names[i].words,
                names[i].unit);
      degrees |= means_degrees(names[i]);
      metres |= means_metres(names[i]) && is_plane((*columns)[i]);
      layout.longitude_first |= names_degrees(names[i].words);
    }
    if (metres) layout.unit = PlaneUnit::metres;
    if (degrees) layout.unit = PlaneUnit::degrees;
    layout.delimiter = delimiter;
    layout.columns = *std::move(columns);
    return true;
  }
  return false;
}

void refuse_feet(const std::string& text, const std::string& where) {
  for (const char* word : {"foot", "feet", "+units=ft", "+units=us-ft", "us-ft", "+to_meter"})
    if (contains(text, word))
      fail_in(where,
              "the unit of the coordinates is not the metre; convert the positions to metres");
}

void set_degrees(std::string_view name, bool like_wgs84, PositionLayout& layout) {
  layout.unit = PlaneUnit::degrees;
  layout.longitude_first = true;
  if (!like_wgs84) layout.other_datum = name;
}

// Codes from 4001 to 4999 are geographic (degrees), except a few geocentric ones (metres).
void read_epsg(std::string_view text, int code, PositionLayout& layout) {
  constexpr std::array kGeocentric{4978, 4936, 4920, 4919};
  constexpr std::array kLikeWgs84{4326, 4979, 4258, 4937, 4269, 4759, 4152};
  if (code > 4000 && code < 5000 && std::ranges::find(kGeocentric, code) == kGeocentric.end())
    set_degrees(text, std::ranges::find(kLikeWgs84, code) != kLikeWgs84.end(), layout);
  else
    layout.unit = PlaneUnit::metres;
}

// The line of OpenDroneMap's geo.txt.
bool read_projection(std::string_view text, const std::string& where, PositionLayout& layout) {
  const std::string words = lower_case(std::string(text));
  if (words.starts_with("epsg:")) {
    const auto code = parse_number<int>(trimmed(std::string_view(words).substr(5)));
    if (!code) return false;
    read_epsg(text, *code, layout);
    return true;
  }
  if (words.starts_with("+proj=")) {
    refuse_feet(words, where);
    layout.unit = PlaneUnit::metres;
    if (words.starts_with("+proj=longlat") || words.starts_with("+proj=latlong"))
      set_degrees(text, contains(words, "wgs84") || contains(words, "grs80"), layout);
    return true;
  }
  if (words == "wgs84" || words == "wgs 84") {
    set_degrees(text, true, layout);
    return true;
  }
  if (!words.starts_with("wgs84 utm ") && !words.starts_with("wgs 84 utm ")) return false;
  layout.unit = PlaneUnit::metres;
  return true;
}

bool read_coordinate_system(std::string_view text, const std::string& where,
                            PositionLayout& layout) {
  const std::string words = lower_case(std::string(text));
  if (!text.starts_with('#') || !contains(words, "coordinatesystem:")) return false;
  refuse_feet(words, where);
  if (contains(words, "projcs") || contains(words, "local_cs") || contains(words, "geoccs"))
    layout.unit = PlaneUnit::metres;
  else if (contains(words, "geogcs"))
    set_degrees("another datum than WGS 84",
                contains(words, "wgs 84") || contains(words, "wgs84") ||
                    contains(words, "etrs89") || contains(words, "nad83"),
                layout);
  return true;
}

}  // namespace

bool read_layout_line(std::string_view text, const std::string& where, PositionLayout& layout) {
  if (text.size() == 5 && lower_case(std::string(text.substr(0, 4))) == "sep=") {
    layout.delimiter = text[4];
    return true;
  }
  return read_coordinate_system(text, where, layout) || read_projection(text, where, layout) ||
         read_header(text, where, layout);
}

}  // namespace axial::io
