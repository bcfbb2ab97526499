// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "calibrate/calibrate.h"

namespace axial::calibrate {

// A drawing (SVG) of where in the image corners were seen: one dot each, coloured by how far it is
// from where the calibrated camera images it, and how many there are in each field of a grid.
std::string coverage_svg(const Calibration& calibration);

}  // namespace axial::calibrate
