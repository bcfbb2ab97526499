// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/position_file.h"

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "private/bytes/text_reader.h"
#include "private/cameras/position_layout.h"
#include "private/cameras/position_row.h"
#include "private/cameras/utm.h"

namespace axial::io {
namespace {

constexpr const char* kRemedy =
    "convert the positions to a projected system in metres, for example in QGIS or by "
    "gdaltransform";

// The lines of the file. Spreadsheets on old systems end lines with a carriage return alone.
std::string text_of(const std::filesystem::path& file) {
  std::string text = read_file(file);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    fail("{}: is UTF-16; save it as UTF-8", file.string());
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

// The rows of a file before their units are known.
struct Rows {
  std::vector<PositionRow> rows;
  std::vector<int> lines;
  PositionLayout layout;
};

Rows read_rows(const std::filesystem::path& file, const IsImage& is_image) {
  const std::string text = text_of(file);
  TextReader reader(text, file.string());
  Rows found;
  int number = 0;
  while (const auto line = reader.line()) {
    const std::string where = fmt::format("{}:{}", file.string(), ++number);
    if (read_layout_line(line->rest(), where, found.layout)) continue;
    auto row = read_position_row(line->rest(), found.layout, is_image, where);
    if (!row) continue;
    found.rows.push_back(*std::move(row));
    found.lines.push_back(number);
  }
  return found;
}

std::size_t drop_empty(Rows& found) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    if (found.rows[i].without_position) continue;
    found.lines[kept] = found.lines[i];
    if (kept != i) found.rows[kept] = std::move(found.rows[i]);
    ++kept;
  }
  const std::size_t dropped = found.rows.size() - kept;
  found.rows.resize(kept);
  found.lines.resize(kept);
  return dropped;
}

void turn_depths(Rows& found, std::vector<std::string>& notes) {
  const auto is_below = [](const PositionRow& row) { return row.is_depth && row.position.z() > 0; };
  if (std::ranges::none_of(found.rows, is_below)) return;
  for (PositionRow& row : found.rows)
    if (row.is_depth) row.position.z() = -row.position.z();
  notes.push_back("depths are positive downwards: their opposites are the heights");
}

struct Box {
  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY), high = -low;
};

Box box_of(const Rows& found) {
  Box box;
  for (const PositionRow& row : found.rows) {
    const Eigen::Array2d place = row.position.head<2>().array();
    box.low = box.low.min(place);
    box.high = box.high.max(place);
  }
  return box;
}

// No camera takes photographs from three places within 1 cm, and degrees of a survey lie as close.
bool are_like_degrees(const Rows& found) {
  constexpr double kClose = 0.01, kFarFromZero = 1;
  const Box box = box_of(found);
  const Eigen::Array2d farthest = box.low.abs().max(box.high.abs());
  return found.rows.size() >= 3 && ((box.high - box.low) < kClose).all() &&
         (box.high - box.low).maxCoeff() > 0 && farthest.maxCoeff() > kFarFromZero &&
         farthest.maxCoeff() <= 180 && farthest.minCoeff() <= 90;
}

// Puts the longitude first.
void order_degrees(Rows& found, const std::string& file) {
  if (found.layout.longitude_first) return;
  const Box box = box_of(found);
  const Eigen::Array2d farthest = box.low.abs().max(box.high.abs());
  if (farthest.x() > 90) return;
  if (farthest.y() <= 90)
    fail(
        "{}: the positions are degrees, but nothing says whether the latitude or the longitude is "
        "first; name the columns in a first line such as label,longitude,latitude,altitude",
        file);
  for (PositionRow& row : found.rows) std::swap(row.position.x(), row.position.y());
}

void convert_degrees(Rows& found, const std::string& file, std::vector<std::string>& notes) {
  if (!found.layout.other_datum.empty())
    fail("{}: the positions are degrees ({}); {}", file, found.layout.other_datum, kRemedy);
  order_degrees(found, file);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const PositionRow& row : found.rows)
    mean += row.position.head<2>() / static_cast<double>(found.rows.size());
  const UtmZone zone = utm_zone(mean.x(), mean.y());
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    const double longitude = found.rows[i].position.x(), latitude = found.rows[i].position.y();
    if (std::abs(latitude) > 84 || std::abs(longitude - mean.x()) > 10)
      fail("{}:{}: longitude {} and latitude {} are not in a UTM zone with the others; {}", file,
           found.lines[i], longitude, latitude, kRemedy);
    found.rows[i].position.head<2>() = to_utm(longitude, latitude, zone);
  }
  notes.push_back(fmt::format(
      "longitude and latitude in degrees were converted to metres, {} (EPSG:{}); heights are "
      "unchanged",
      zone.name(), zone.epsg()));
}

void bring_to_metres(Rows& found, const std::string& file, std::vector<std::string>& notes) {
  const PlaneUnit unit = found.layout.unit;
  if (found.rows.empty()) return;
  if (unit == PlaneUnit::degrees || (unit == PlaneUnit::unknown && are_like_degrees(found)))
    convert_degrees(found, file, notes);
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
  if (const std::size_t empty = drop_empty(found))
    result.notes.push_back(fmt::format("{} lines have no coordinates and are skipped", empty));
  turn_depths(found, result.notes);
  bring_to_metres(found, file.string(), result.notes);
  note_accuracies(found, result.notes);
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    PositionRow& row = found.rows[i];
    result.positions.push_back(
        {std::move(row.name), row.position, found.lines[i], row.known, row.sigma});
  }
  return result;
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
