// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axial::experiments {

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const std::string& cell : rows[r]) text += "| " + cell + " ";
    text += "|\n";
    if (r > 0) continue;
    for (std::size_t k = 0; k < rows[r].size(); ++k) text += "|---";
    text += "|\n";
  }
  return text;
}

std::string significant(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  const auto last_digit = [&](double x) {
    return static_cast<int>(std::floor(std::log10(std::abs(x)))) - digits + 1;
  };
  const double unit = std::pow(10, last_digit(value));
  const double rounded = std::round(value / unit) * unit;
  // Rounding has added a digit: 9.996 became 10.00.
  const int decimals = -last_digit(rounded * (1 + 1e-12));
  return fmt::format("{:.{}f}", rounded, std::max(0, decimals));
}

}  // namespace axial::experiments
