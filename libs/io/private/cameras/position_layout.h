// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: how the lines of a file of positions are divided into columns, and what the
// columns mean. Metashape, Pix4D, OpenDroneMap and spreadsheets write such lines before the first
// position.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "private/only_for_io.h"

namespace axial::io {

// The meaning of a column. `depth` is positive downwards. The sigmas are standard deviations: of
// all coordinates, of the two horizontal ones, of the height.
enum class Column { other, label, x, y, z, depth, sigma, sigma_across, sigma_up };

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

// Removes and returns the quoted text at the beginning of `text`, in which "" stands for one quote;
// nothing if the quote is not closed. Precondition: the text begins with a quote.
std::optional<std::string> take_quoted(std::string_view& text);

// The fields of `text` between delimiters, without blanks around them. A field in double quotes may
// contain delimiters; "" between the quotes stands for one quote. Nothing if a quote is not closed.
std::optional<std::vector<std::string>> split_fields(std::string_view text, char delimiter);

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

}  // namespace axial::io
