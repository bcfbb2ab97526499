// SPDX-License-Identifier: GPL-3.0-or-later
// Writes files of targets, scale bars and control points. read_control() reads the same numbers
// from them, as far as the format holds them. Each file is written completely or not at all. Error
// that names the file if it cannot be written, or if its format cannot hold a label or a value.
#pragma once

#include <filesystem>

#include "control/control.h"

namespace axial::control {

// Our JSON: points, bars and observations, with everything but the notes.
void write_control_json(const std::filesystem::path& file, const Control& control);

// gcp_list.txt of OpenDroneMap: a line for each observation of a target whose x and y are known.
// The file holds no standard deviations and no checks. Blanks in labels become underscores. Error
// if no observation has known coordinates, if `control.crs` is no code, and for blanks in the name
// of a photograph.
void write_gcp_list(const std::filesystem::path& file, const Control& control);

// Metashape's XML of markers: observations without their standard deviations, points and bars.
// Checks are references that are not enabled.
void write_metashape_markers(const std::filesystem::path& file, const Control& control);

// Metashape's reference as CSV: the points.
void write_metashape_reference(const std::filesystem::path& file, const Control& control);

// ReefShape's scale bars. A fifth field, "check", marks checks.
void write_reefshape_bars(const std::filesystem::path& file, const Control& control);

// ReefShape's control: the points as latitude, longitude and depth on WGS 84. The larger of the two
// horizontal standard deviations is that of both. A column `check` is added if there are checks.
// Error if `control.crs` is empty, or for a point above the surface (z above 0).
void write_reefshape_control(const std::filesystem::path& file, const Control& control);

}  // namespace axial::control
