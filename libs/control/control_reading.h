// SPDX-License-Identifier: GPL-3.0-or-later
// How files of control are read.
#pragma once

namespace axial::control {

// The part of a file that the caller needs.
enum class Role { any, images, points, bars };

struct ControlReading {
  // Error if the file has none of this.
  Role role = Role::any;
  // The code of the projected system, with metres as unit, to which coordinates are transformed; 0:
  // none is given. Degrees then go to the UTM zone of their mean, and coordinates in metres stay.
  int epsg = 0;
  // Standard deviations [m] where a file states none, or 0.
  double point_sigma = 0.01;
  double bar_sigma = 0.0005;
};

}  // namespace axial::control
