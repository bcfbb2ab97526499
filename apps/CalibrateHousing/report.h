// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a calibration, for the log and as JSON.
#pragma once

#include <string>
#include <vector>

#include "calibrate/advice.h"

namespace axial::apps {

// The table of photographs and the calibrated numbers for the log, one entry for each line.
std::vector<std::string> report_lines(const calibrate::Calibration& calibration,
                                      const std::string& port_name);

// The same numbers as JSON, with the photographs that are left out, what the photographs lack, and
// the next photograph to take.
std::string report_json(const calibrate::Calibration& calibration, const calibrate::Limits& limits);

}  // namespace axial::apps
