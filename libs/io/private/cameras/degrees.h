// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: positions whose first two coordinates are longitude and latitude in degrees.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "io/cameras/position_file.h"
#include "private/only_for_io.h"

namespace axial::io {

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

}  // namespace axial::io
