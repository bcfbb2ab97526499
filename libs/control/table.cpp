// SPDX-License-Identifier: GPL-3.0-or-later
// Tables: ReefShape's scale bars and control, Metashape's reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/split.h"
#include "control/labels.h"
#include "io/cameras/table_text.h"
#include "private/readers.h"
#include "private/stated_points.h"
#include "private/table_columns.h"

namespace axial::control {
namespace {

using Fields = std::vector<std::string>;

// The delimiter that gives most fields.
char delimiter_of(std::string_view line) {
  char best = ',';
  for (const char delimiter : {';', '\t'})
    if (std::ranges::count(line, delimiter) > std::ranges::count(line, best)) best = delimiter;
  return best;
}

// A line of the file that is neither empty nor a comment.
struct Line {
  std::string_view text;
  std::string where;
};

struct Table {
  std::vector<Line> lines;    // without the header
  std::optional<Line> crs;    // the text behind "CoordinateSystem:"
  std::optional<Line> names;  // the last comment before the first line, as Metashape writes it
};

Table table_of(const std::string& text, const std::string& file) {
  Table table;
  int number = 0;
  for (std::string_view line : split(text, '\n')) {
    const std::string where = fmt::format("{}:{}", file, ++number);
    line = trimmed(line);
    if (line.empty()) continue;
    if (!line.starts_with('#')) {
      table.lines.push_back({line, where});
      continue;
    }
    constexpr std::string_view kSystem = "coordinatesystem:";
    const std::size_t at = lower_case(std::string(line)).find(kSystem);
    if (at != std::string::npos)
      table.crs = {trimmed(line.substr(at + kSystem.size())), where};
    else if (table.lines.empty())
      table.names = {line.substr(1), where};
  }
  return table;
}

Fields fields_of(const Line& line, char delimiter) {
  auto fields = io::split_fields(line.text, delimiter);
  if (!fields) fail_in(line.where, "a quote is not closed");
  return *std::move(fields);
}

std::optional<Header> header_in(const Line& line) {
  const char delimiter = delimiter_of(line.text);
  const auto fields = io::split_fields(line.text, delimiter);
  const auto reads_as_number = [](const std::string& field) {
    return io::number_in(field).has_value();
  };
  if (!fields || std::ranges::any_of(*fields, reads_as_number)) return {};
  Header header = header_of(*fields, delimiter, line.where);
  if (!header.has(Meaning::label)) return {};
  return header;
}

void require_columns(const Header& header, const std::string& where) {
  for (const auto& [meaning, name] :
       {std::pair{Meaning::x, "x, easting or longitude"}, {Meaning::y, "y, northing or latitude"}})
    if (!header.has(meaning)) fail_in(where, "the header has no column {}", name);
  if (!header.has(Meaning::z) && !header.has(Meaning::depth))
    fail_in(where, "the header has no column z, altitude or depth");
}

// An empty field is no number: NaN.
double number_or_none(const std::string& field, const std::string& where) {
  if (field.empty()) return kNoNumber;
  const auto number = io::number_in(field);
  if (!number) fail_in(where, "'{}' is not a number", field);
  return *number;
}

double sigma_in(const std::string& field, const std::string& where) {
  const double sigma = number_or_none(field, where);
  return std::isnan(sigma) ? 0 : sigma;
}

bool flag_in(const std::string& field, const std::string& where) {
  const std::string word = lower_case(field);
  if (word.empty() || word == "0" || word == "false" || word == "no") return false;
  if (word == "1" || word == "true" || word == "yes" || word == "check") return true;
  fail_in(where, "'{}' is neither true nor false", field);
}

void take_field(const std::string& field, Meaning meaning, StatedPoint& point) {
  const std::string at = point.label.empty() ? point.where : point.where + ": " + point.label;
  switch (meaning) {
    case Meaning::x:
    case Meaning::y:
      point.place[meaning == Meaning::x ? 0 : 1] = number_or_none(field, at);
      break;
    case Meaning::z:
    case Meaning::depth:
      point.place.z() = number_or_none(field, at);
      point.is_depth = meaning == Meaning::depth;
      break;
    case Meaning::sigma:
      point.sigma.setConstant(sigma_in(field, at));
      break;
    case Meaning::sigma_xy:
      point.sigma.head<2>().setConstant(sigma_in(field, at));
      break;
    case Meaning::sigma_x:
      point.sigma.x() = sigma_in(field, at);
      break;
    case Meaning::sigma_y:
      point.sigma.y() = sigma_in(field, at);
      break;
    case Meaning::sigma_z:
      point.sigma.z() = sigma_in(field, at);
      break;
    case Meaning::check:
      point.check |= flag_in(field, at);
      break;
    case Meaning::enabled:
      point.check |= !field.empty() && !flag_in(field, at);
      break;
    case Meaning::label:
    case Meaning::other:
      break;
  }
}

// A bare number is that of a circular target.
std::string full_label(const std::string& label) {
  return is_number(label) ? "target " + label : label;
}

StatedPoint point_in(const Line& line, const Header& header) {
  Fields fields = fields_of(line, header.delimiter);
  while (fields.size() > header.columns.size() && fields.back().empty()) fields.pop_back();
  if (fields.size() > header.columns.size())
    fail_in(line.where, "has {} fields, but the header names {} columns", fields.size(),
            header.columns.size());
  StatedPoint point;
  point.where = line.where;
  const auto label = std::ranges::find(header.columns, Meaning::label) - header.columns.begin();
  if (static_cast<std::size_t>(label) < fields.size())
    point.label = full_label(fields[static_cast<std::size_t>(label)]);
  // One accuracy for all coordinates comes first, so that those of single coordinates replace it.
  for (const bool of_all : {true, false})
    for (std::size_t i = 0; i < fields.size(); ++i)
      if ((header.columns[i] == Meaning::sigma) == of_all)
        take_field(fields[i], header.columns[i], point);
  return point;
}

Control read_points(const Table& table, const Header& header, const std::filesystem::path& file,
                    const ControlReading& options) {
  StatedPoints stated;
  stated.degrees = header.degrees || (header.may_be_degrees && !table.crs);
  if (table.crs) {
    stated.crs = table.crs->text;
    stated.crs_where = table.crs->where;
  }
  for (const Line& line : table.lines) {
    StatedPoint point = point_in(line, header);
    if (point.place.array().isNaN().all()) continue;  // such as markers without a reference
    stated.points.push_back(std::move(point));
  }
  Control control;
  add_points(std::move(stated), file, options, control);
  return control;
}

bool is_bar(const Fields& fields) {
  return fields.size() >= 3 && fields.size() <= 5 && io::number_in(fields[2]);
}

Bar bar_in(const Line& line) {
  const char delimiter = delimiter_of(line.text);
  const Fields fields = fields_of(line, delimiter);
  if (!is_bar(fields)) fail_in(line.where, "must be TARGET,TARGET,LENGTH[,ACCURACY[,check]]");
  Bar bar{full_label(fields[0]),
          full_label(fields[1]),
          *io::number_in(fields[2]),
          0,
          false,
          line.where};
  if (fields.size() > 3) bar.sigma = sigma_in(fields[3], line.where);
  if (fields.size() > 4) bar.check = flag_in(fields[4], line.where);
  return bar;
}

// Some users write names above ReefShape's columns. Error if they state another unit than the
// metre.
bool names_length(const Line& line) {
  const Fields fields = fields_of(line, delimiter_of(line.text));
  if (fields.size() < 3 || io::number_in(fields[2])) return false;
  const io::ColumnName name = io::column_name(fields[2]);
  const bool is_length = name.words.starts_with("length") || name.words.starts_with("distance");
  if (!is_length) return false;
  const std::vector<std::string_view> words = split(name.words, ' ');
  const bool states_metres = words.size() == 1 || (words.size() == 2 && io::is_metre(words[1]));
  if (!states_metres || (!name.unit.empty() && !io::is_metre(name.unit)))
    fail_in(line.where, "column '{}' must be in metres", fields[2]);
  return true;
}

Control read_bars(const Table& table, const ControlReading& options) {
  Control control;
  for (std::size_t i = 0; i < table.lines.size(); ++i)
    if (i > 0 || !names_length(table.lines[i])) add_bar(bar_in(table.lines[i]), options, control);
  return control;
}

}  // namespace

Control read_table(const std::string& text, const std::filesystem::path& file,
                   const ControlReading& options) {
  Table table = table_of(text, file.string());
  if (table.names)
    if (const auto header = header_in(*table.names); header && header->has(Meaning::x)) {
      require_columns(*header, table.names->where);
      return read_points(table, *header, file, options);
    }
  if (table.lines.empty()) fail_in(file, "has no points and no bars");
  const Line first = table.lines.front();
  const auto header = header_in(first);
  const bool is_points = header && !names_length(first);
  if (!is_points && (options.role != Role::points)) return read_bars(table, options);
  if (!is_points)
    fail_in(first.where, "must be a header that names the columns, such as label,x,y,z,accuracy");
  require_columns(*header, first.where);
  table.lines.erase(table.lines.begin());
  return read_points(table, *header, file, options);
}

}  // namespace axial::control
