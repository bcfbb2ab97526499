// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that the reports of this library have in common. Lengths are metres in the JSON and
// millimetres in the rows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/statistics.h"

namespace axial::evaluate {

nlohmann::ordered_json to_json(const DistanceStatistics& statistics);
nlohmann::ordered_json to_json(const std::vector<Score>& scores);

// statistics_header() returns a line with the names of the columns. The first name is `title`.
// statistics_row() returns a line with `name` and the numbers in these columns.
std::string statistics_header(const char* title);
std::string statistics_row(const char* name, const DistanceStatistics& statistics);

// Returns a line with the names of the columns, and one line for each score.
std::string score_rows(const std::vector<Score>& scores);

}  // namespace axial::evaluate
