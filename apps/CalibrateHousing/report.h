// SPDX-License-Identifier: GPL-3.0-or-later
// What a calibration came to, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "calibrate/advice.h"

// Tables for the log: one line each.
std::vector<std::string> report_lines(const axial::calibrate::Calibration& calibration,
                                      const std::string& port_name);

std::string report_json(const axial::calibrate::Calibration& calibration,
                        const axial::calibrate::Limits& limits);
