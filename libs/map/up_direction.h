// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "axial/base.h"

namespace axial::map {

// Parses the upward direction of a map, "X,Y,Z", of any length above 0. The largest component of
// the result is 1 or -1. Empty for an empty text. `epsg`: the code of the map's coordinate
// reference system; 0: none. Throws an Error that names the setting "up" if the text is
// not three finite numbers, if all are zero, or if `epsg` is given and the direction is not that of
// the z axis, along which a reference system has heights.
std::optional<Eigen::Vector3d> parse_up(const std::string& text, int epsg);

// The text "X,Y,Z" of a direction, as parse_up() reads it.
std::string up_text(const Eigen::Vector3d& up);

// True if a map with the upward direction `up` shows the far side of a surface. `facing`: the mean,
// weighted by area, of the unit normals of the surface on its near side; zero: not known. The far
// side is certain if the mean points downwards by more than 0.2: walls and closed surfaces have a
// mean about 0.
bool shows_far_side(const Eigen::Vector3d& up, const Eigen::Vector3d& facing);

}  // namespace axial::map
