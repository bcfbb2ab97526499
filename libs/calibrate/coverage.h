// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "calibrate/calibrate.h"

namespace axial::calibrate {

// A drawing (SVG) of the corners' places in the image: one dot for each corner, with a colour for
// its reprojection error, and the number of corners in each field of a grid.
std::string coverage_svg(const Calibration& calibration);

}  // namespace axial::calibrate
