// SPDX-License-Identifier: GPL-3.0-or-later
// Reports how well known positions agree with the refined cameras.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pose/refine.h"

namespace axial::apps {

// The line for the log: how far the positions lie from the cameras, and the standard
// deviation of their coordinates. No line if no position was used.
std::vector<std::string> position_lines(const pose::RefineReport& report);

// The warnings: positions that deviate more than their stated standard deviations let expect, and
// positions that made the reprojection errors larger.
std::vector<std::string> position_warnings(const pose::RefineReport& report);

// The same as JSON: the object "positions" of report.json. Null if no position was used.
nlohmann::ordered_json positions_json(const pose::RefineReport& report);

}  // namespace axial::apps
