// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "calibrate/calibrate.h"

namespace axial::calibrate {

// Returns a drawing (SVG) of the places of the corners in the image. Each corner is a dot, whose
// colour shows the corner's reprojection error. The drawing also shows the number of corners in
// each cell of a grid.
std::string coverage_svg(const Calibration& calibration);

}  // namespace axial::calibrate
