// SPDX-License-Identifier: GPL-3.0-or-later
// Markdown tables.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

// Returns the table with these rows of cells. The first row is the header. Each line ends with a
// line break. Preconditions: all rows have the same length, and no cell contains "|" or a line
// break.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

// A number, rounded to `digits` significant digits, without an exponent: with 3 digits "0.267",
// "0.00221", "24600". "0" for 0. "inf", "-inf" or "nan" for numbers that are not finite.
// Precondition: `digits` is at least 1.
std::string significant(double value, int digits = 3);

}  // namespace axial::experiments
