// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/control: the columns of a table of points, by their names.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace axial::control {

// The meaning of a column. x and y may be longitude and latitude. `depth`: a height with any sign.
// The sigmas are standard deviations [m]: of all coordinates, of x and y, of one.
enum class Meaning {
  other,
  label,
  x,
  y,
  z,
  depth,
  sigma,
  sigma_xy,
  sigma_x,
  sigma_y,
  sigma_z,
  check,
  enabled
};

struct Header {
  char delimiter = 0;
  std::vector<Meaning> columns;
  bool degrees = false;         // the names leave no other meaning than longitude and latitude
  bool may_be_degrees = false;  // a name such as "x/longitude"

  bool has(Meaning meaning) const { return std::ranges::find(columns, meaning) != columns.end(); }
};

// The columns of these names, and `other` for columns after the first of each kind. Error that
// begins with `where` for coordinates in another unit than metres and degrees.
Header header_of(const std::vector<std::string>& names, char delimiter, const std::string& where);

}  // namespace axial::control
