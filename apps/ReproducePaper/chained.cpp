// SPDX-License-Identifier: GPL-3.0-or-later
#include "chained.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/tables.h"

namespace axial {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values.at(half) : 0.5 * (values.at(half - 1) + values.at(half));
}

std::string millimetres(const Json& metres) {
  return metres.is_null() ? "-" : experiments::significant(1e3 * metres.get<double>());
}

std::string percent(const Json& fraction) {
  return fraction.is_null() ? "-" : fmt::format("{:.1f}", 100 * fraction.get<double>());
}

}  // namespace axial
