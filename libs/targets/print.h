// SPDX-License-Identifier: GPL-3.0-or-later
// Plates and scale bars to print.
#pragma once

#include <cstddef>
#include <string>

#include "targets/codes/family.h"

namespace axial::targets {

// Returns a drawing (SVG, to scale: 1 unit is 1 mm) of the target `number` of `family` on a plate
// with sides of `side` metres. The label and the side stand below the plate, because a printer may
// change the scale. Throws an Error for a number that the family does not have. Precondition:
// `side` is above 0.
std::string plate_svg(const Family& family, std::size_t number, double side);

// Returns a drawing of a scale bar: two plates with a distance of `length` metres between their
// centres. Throws an Error for equal numbers, for a number that the family does not have, and if
// the plates would overlap.
std::string bar_svg(const Family& family, std::size_t first, std::size_t second, double side,
                    double length);

}  // namespace axial::targets
