// SPDX-License-Identifier: GPL-3.0-or-later
// Markdown tables.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

// The first row is the header. Precondition: all rows have the same length.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

// A number with `digits` significant digits and without an exponent: 0.2671, 0.00221, 24600.
std::string significant(double value, int digits = 3);

}  // namespace axial::experiments
