// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of tables, from the numbers of a result.
#pragma once

#include <string>

#include "experiments/experiment.h"

namespace axial::experiments {

// A length in metres as millimetres with three significant digits: "0.871" for 0.000871. "-" for
// null. Precondition: `metres` is a number or null.
std::string millimetres(const Json& metres);

// A fraction in percent with one decimal: "74.2" for 0.742. "-" for null. Precondition: `fraction`
// is a number or null.
std::string percent(const Json& fraction);

}  // namespace axial::experiments
