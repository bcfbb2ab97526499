// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the result of a calibration, as lines for the log and as JSON.
#pragma once

#include <string>
#include <vector>

#include "calibrate/advice.h"

namespace axial::apps {

// Returns the lines for the log: the table of photographs and the calibrated numbers. `port_name`:
// the name of the port in the housing file.
std::vector<std::string> report_lines(const calibrate::Calibration& calibration,
                                      const std::string& port_name);

// Returns the same numbers as JSON, and also the photographs that are left out, the gaps of the
// photographs (calibrate/advice.h), and the next photograph to take.
std::string report_json(const calibrate::Calibration& calibration, const calibrate::Limits& limits);

}  // namespace axial::apps
