// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/position_file.h"

#include <algorithm>
#include <cmath>

#include "bytes/private/text_reader.h"
#include "cameras/private/position_parts.h"

namespace axial::io {
namespace {

// The rows of a file before their units are known.
struct Rows {
  std::vector<PositionRow> rows;
  PositionLayout layout;
};

Rows read_rows(const std::filesystem::path& file, const IsImage& is_image) {
  const std::string text = read_table_text(file);
  TextReader reader(text, file.string());
  Rows found;
  int number = 0;
  while (const auto line = reader.line()) {
    const std::string where = fmt::format("{}:{}", file.string(), ++number);
    if (read_layout_line(line->rest(), where, found.layout)) continue;
    auto row = read_position_row(line->rest(), found.layout, is_image, where);
    if (!row) continue;
    row->line = number;
    found.rows.push_back(*std::move(row));
  }
  return found;
}

void turn_depths(Rows& found, std::vector<std::string>& notes) {
  const auto is_below = [](const PositionRow& row) { return row.is_depth && row.position.z() > 0; };
  if (std::ranges::none_of(found.rows, is_below)) return;
  for (PositionRow& row : found.rows)
    if (row.is_depth) row.position.z() = -row.position.z();
  notes.push_back("depths are positive downwards: their opposites are the heights");
}

std::vector<Eigen::Vector3d> places_of(const Rows& found) {
  std::vector<Eigen::Vector3d> places;
  for (const PositionRow& row : found.rows) places.push_back(row.position);
  return places;
}

// The order of degrees that a file states to be degrees.
DegreeOrder stated_order(std::span<const Eigen::Vector3d> places, bool longitude_first,
                         const std::string& file) {
  const std::vector<DegreeOrder> orders = possible_orders(places, longitude_first);
  if (orders.size() > 1) fail_in(file, "{}", kUnknownOrder);
  if (orders.empty())
    fail_in(file,
            "the positions are degrees, but some are beyond the longitudes and latitudes of the "
            "Earth");
  return orders.front();
}

PositionReading read_stated_degrees(const Rows& found, const std::string& file) {
  if (!found.layout.other_datum.empty())
    fail_in(file, "the positions are degrees ({}); {}", found.layout.other_datum, kProjectRemedy);
  const std::vector<Eigen::Vector3d> places = places_of(found);
  std::vector<int> lines;
  for (const PositionRow& row : found.rows) lines.push_back(row.line);
  return read_as_degrees(places, stated_order(places, found.layout.longitude_first, file), file,
                         lines);
}

// The readings as degrees of a file that does not state its unit.
std::vector<PositionReading> possible_degrees(const Rows& found, const std::string& file) {
  std::vector<PositionReading> readings;
  if (found.layout.unit != PlaneUnit::unknown) return readings;
  std::vector<std::size_t> rows;
  std::vector<Eigen::Vector3d> places;
  std::vector<int> lines;
  for (std::size_t row = 0; row < found.rows.size(); ++row) {
    if (!found.rows[row].known || is_lost_fix(found.rows[row].position)) continue;
    rows.push_back(row);
    places.push_back(found.rows[row].position);
    lines.push_back(found.rows[row].line);
  }
  for (const DegreeOrder order : orders_without_unit(places, found.layout.longitude_first)) {
    PositionReading reading = read_as_degrees(places, order, file, lines);
    std::vector<Eigen::Vector3d> all = places_of(found);
    for (std::size_t k = 0; k < rows.size(); ++k) all[rows[k]] = reading.positions[k];
    reading.positions = std::move(all);
    readings.push_back(std::move(reading));
  }
  return readings;
}

void note_accuracies(const Rows& found, std::vector<std::string>& notes) {
  if (std::ranges::any_of(found.rows, &PositionRow::sigma_guessed))
    notes.push_back(
        "numbers behind the coordinates are taken as the accuracies of the plane coordinates and "
        "of "
        "the height");
}

}  // namespace

PositionFile read_positions(const std::filesystem::path& file, const IsImage& is_image) {
  Rows found = read_rows(file, is_image);
  PositionFile result;
  if (const auto empty =
          std::erase_if(found.rows, [](const PositionRow& row) { return row.without_position; }))
    result.notes.push_back(fmt::format("{} lines have no coordinates and are skipped", empty));
  turn_depths(found, result.notes);
  std::vector<Eigen::Vector3d> places = places_of(found);
  if (found.layout.unit == PlaneUnit::degrees && !places.empty()) {
    PositionReading degrees = read_stated_degrees(found, file.string());
    places = std::move(degrees.positions);
    result.notes.push_back(std::move(degrees.note));
  }
  result.as_degrees = possible_degrees(found, file.string());
  note_accuracies(found, result.notes);
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    PositionRow& row = found.rows[i];
    result.positions.push_back({std::move(row.name), places[i], row.line, row.known, row.sigma});
  }
  return result;
}

std::vector<std::string> split_list(std::string_view text, const std::string& where) {
  std::vector<std::string> fields;
  while (true) {
    std::string field;
    if (text.starts_with('"')) {
      const auto quoted = take_quoted(text);
      if (!quoted) fail_in(where, "a quote is not closed");
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
