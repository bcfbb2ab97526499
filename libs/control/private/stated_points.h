// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/control: points as files state them, before units and systems are understood.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "control/control.h"
#include "control/control_reading.h"

namespace axial::control {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

struct StatedPoint {
  std::string label;
  // x or longitude, y or latitude, height or depth. NaN: not known.
  Eigen::Vector3d place = Eigen::Vector3d::Constant(kNoNumber);
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  // [m]; 0: not stated
  bool is_depth = false;  // the third coordinate is the number of a column of depths
  bool check = false;
  std::string where;
};

struct StatedPoints {
  std::vector<StatedPoint> points;
  std::string crs;        // as the file states it; empty: not stated
  std::string crs_where;  // its line or entry, for messages
  bool degrees = false;   // names of columns or keys say longitude and latitude
};

// Adds the points to `control`, in metres, with its crs and notes. Errors of read_control() for
// labels that have two places, depths of both signs, standard deviations, and systems.
void add_points(StatedPoints stated, const std::filesystem::path& file,
                const ControlReading& options, Control& control);

// Adds a bar. `sigma` 0: not stated. Errors of read_control() for a length that is not positive,
// for two labels of one target, and if `control` has another length of the same bar.
void add_bar(Bar bar, const ControlReading& options, Control& control);

// `value` of `field` is finite, or Error.
double finite(double value, const std::string& where, const std::string& field);

}  // namespace axial::control
