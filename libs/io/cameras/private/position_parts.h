// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the parts of the reader of position files.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "io/cameras/position_file.h"
#include "io/cameras/table_text.h"

namespace axial::io {

// The unit of the first two coordinates. `unknown`: no line states it.
enum class PlaneUnit { unknown, metres, degrees };

struct PositionLayout {
  char delimiter = 0;           // between columns; 0: blanks, or not stated
  std::vector<Column> columns;  // of the header line; empty: the file has none
  PlaneUnit unit = PlaneUnit::unknown;
  bool longitude_first =
      false;                // true: a line says that x is the longitude, if the unit is degrees
  std::string other_datum;  // degrees that do not belong to WGS 84 or an equal datum: its name
};

// Reads a line before the first position into `layout`. Returns whether the line has one of these
// forms:
//   sep=;                       the delimiter, as spreadsheets write it
//   #Label,X/Longitude,...      names of columns, with or without `#`, between any delimiters; they
//                               must name the label and three coordinates, and may state the unit
//                               in brackets: label,x (m),y (m),z (m)
//   # CoordinateSystem: WKT     as Metashape writes it
//   EPSG:32633, +proj=..., WGS84 UTM 33N   as OpenDroneMap expects it
// Error that begins with `where` if the line states a unit that is neither metres nor degrees.
bool read_layout_line(std::string_view text, const std::string& where, PositionLayout& layout);

// The values of one line, in the order and the units of the file.
struct PositionRow {
  std::string name;
  int line = 0;  // its number in the file, from 1; not set by read_position_row()
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> sigma = {};
  bool known = false;             // the result of `is_image` for the name
  bool is_depth = false;          // the third coordinate is positive downwards
  bool sigma_guessed = false;     // no header says that these numbers are accuracies
  bool without_position = false;  // the fields of the coordinates are empty
};

// Reads a line in one of the forms of read_positions(). Nothing for an empty line and a comment.
// Error that begins with `where` for a line of another form and for numbers that are not finite.
std::optional<PositionRow> read_position_row(std::string_view text, const PositionLayout& layout,
                                             const IsImage& is_image, const std::string& where);

// The end of errors about degrees that cannot be converted.
inline constexpr const char* kProjectRemedy =
    "convert the positions to a projected system in metres, for example in QGIS or by "
    "gdaltransform";

// The sentence of the error for degrees that may have either order.
inline constexpr const char* kUnknownOrder =
    "the positions are degrees, but nothing says whether the latitude or the longitude is first; "
    "name the columns in a first line such as label,longitude,latitude,altitude";

// Whether coordinates are 0 0, as receivers without a fix write them.
bool is_lost_fix(const Eigen::Vector3d& position);

enum class DegreeOrder { longitude_first, latitude_first };

// "longitude and latitude in degrees", or the other order.
std::string words_for(DegreeOrder order);

// The orders in which the first two coordinates can be degrees on the Earth. `longitude_first`: a
// line of the file says so.
std::vector<DegreeOrder> possible_orders(std::span<const Eigen::Vector3d> positions,
                                         bool longitude_first);

// The orders in which coordinates of an unknown unit can be degrees of a survey, in the range of
// UTM. None unless there are three positions or more, x and y are not constant and vary by at most
// 0.1 (11 km), and some x or y is more than 1 from zero.
std::vector<DegreeOrder> orders_without_unit(std::span<const Eigen::Vector3d> positions,
                                             bool longitude_first);

// The positions in metres, in the UTM zone of their mean; heights are unchanged. Error that begins
// with `file` and names the line if a position is not in this zone. `lines`: of the positions.
// Precondition: there are positions.
PositionReading read_as_degrees(std::span<const Eigen::Vector3d> positions, DegreeOrder order,
                                const std::string& file, std::span<const int> lines);

// The right reading.
struct ChosenUnit {
  std::optional<std::size_t> as_degrees;  // index into PositionFile::as_degrees; nothing: metres
  std::string note;                       // how the unit was found
};

// Chooses between the positions of `read` as metres and PositionFile::as_degrees, which are not
// empty. A reading is better, the smaller the residual of the similarity is (robust_similarity())
// that maps the camera centres to the positions, as a part of the extent of the positions. The best
// reading is right if its residual is at most half of every other one, or a tenth with fewer than
// six images. Otherwise UnclearUnit that begins with `file` and says how the user states the unit.
// `centres`: of the images that have positions, in any frame and unit. `rows`: the indices of their
// positions. With fewer than three, no similarity is determined, and the positions are metres.
ChosenUnit choose_unit(const PositionFile& read, std::span<const std::size_t> rows,
                       std::span<const Eigen::Vector3d> centres, const std::string& file);

}  // namespace axial::io
