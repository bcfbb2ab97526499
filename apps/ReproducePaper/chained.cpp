// SPDX-License-Identifier: GPL-3.0-or-later
#include "chained.h"

#include <fmt/format.h>

#include "experiments/tables.h"

namespace axial {

std::string millimetres(const Json& metres) {
  return metres.is_null() ? "-" : experiments::significant(1e3 * metres.get<double>());
}

std::string percent(const Json& fraction) {
  return fraction.is_null() ? "-" : fmt::format("{:.1f}", 100 * fraction.get<double>());
}

}  // namespace axial
