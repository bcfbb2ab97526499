// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that the reports of this library have in common. Lengths are metres in the JSON and
// millimetres in the rows. Every line ends with a line break.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/statistics.h"

namespace axial::evaluate {

// Returns an object. Its field "percentiles" is an object with the percentiles as keys: "50".
nlohmann::ordered_json to_json(const DistanceStatistics& statistics);

// Returns a list with one object for each score, in the order of `scores`.
nlohmann::ordered_json to_json(const std::vector<Score>& scores);

// statistics_header() returns a line with the names of the columns. The first name is `title`.
// statistics_row() returns a line with `name` and the numbers in these columns. Columns stay
// aligned if `title` and `name` have at most 22 characters.
std::string statistics_header(const char* title);
std::string statistics_row(const char* name, const DistanceStatistics& statistics);

// Returns a line with the names of the columns, and one line for each score, in the order of
// `scores`.
std::string score_rows(const std::vector<Score>& scores);

}  // namespace axial::evaluate
