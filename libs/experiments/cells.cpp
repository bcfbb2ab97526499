// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/cells.h"

#include <fmt/format.h>

#include "experiments/tables.h"

namespace axial::experiments {

std::string millimetres(const Json& metres) {
  return metres.is_null() ? "-" : significant(1e3 * metres.get<double>());
}

std::string percent(const Json& fraction) {
  return fraction.is_null() ? "-" : fmt::format("{:.1f}", 100 * fraction.get<double>());
}

}  // namespace axial::experiments
