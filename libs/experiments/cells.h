// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of tables, from the numbers of a result.
#pragma once

#include <string>

#include "experiments/experiment.h"

namespace axial::experiments {

// A length in metres as millimetres with three significant digits: "0.871". "-" for null.
std::string millimetres(const Json& metres);

// A fraction in percent with one decimal: "74.2". "-" for null.
std::string percent(const Json& fraction);

}  // namespace axial::experiments
