// SPDX-License-Identifier: GPL-3.0-or-later
// Reads files of targets, scale bars and control points. Start here to read libs/control.
#pragma once

#include <filesystem>

#include "control/control.h"
#include "control/control_reading.h"

namespace axial::control {

// Reads a file, whose format is found by its content (docs/formats.md, "Control"):
//
// 1. Our JSON: targets.json of FindTargets, and files with points and bars.
// 2. gcp_list.txt of OpenDroneMap: observations and points. A point without a name is called
//    "point N", where N counts the different coordinates from 1.
// 3. Metashape's XML of markers, also inside a project: observations, points and scale bars. A
//    projection that is not pinned is no observation; a reference that is not enabled is a check.
// 4. Metashape's reference as CSV, and ReefShape's control: tables whose header names the columns.
// 5. ReefShape's scale bars: TARGET,TARGET,LENGTH[,ACCURACY[,check]].
//
// Longitude and latitude become metres by GDAL. Heights are not transformed. A number that is empty
// or NaN is not known. Depths of a file are below the surface if they are positive (z = -depth),
// and are heights if they are negative; a note says which. `Control::crs` is "EPSG:N", or the
// definition of the system if it has no code.
//
// Error of one line, which names the file, the line or the entry, and the label, for a file that
// cannot be read or is none of these; a file that lacks the part of `role`; a label that has two
// places, or two targets that have two distances; numbers that are not finite, lengths and standard
// deviations that are not positive, depths of both signs; a column that is missing; a system that
// PROJ does not know, and one in another unit than degrees or metres unless `epsg` is given. Labels
// of bars need not be those of points or observations.
Control read_control(const std::filesystem::path& file, const ControlReading& options);

// Appends the contents of a file to those of others. Error that names both places for a point or a
// bar that both have with other numbers, and the place of a point of `more` whose x and y are in
// another system. Points and bars that both have are kept once.
void append(Control& control, Control more);

// Sets Control::map_scale, at the mean of the points of which x and y are known. It is 1 if there
// are none, if their system is not stated or not projected, and if it differs from 1 by at most
// 1e-5.
void set_map_scale(Control& control);

}  // namespace axial::control
