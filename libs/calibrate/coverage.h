// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "calibrate/calibrate.h"

namespace axial::calibrate {

// Returns a drawing, as the text of an SVG file, of the places of the corners in the image. Each
// corner that calibrate() did not drop is a dot. Its colour shows the corner's reprojection error:
// blue up to the RMS of all errors, orange up to twice the RMS, red above. The drawing has a grid
// of 8 x 6 cells, and shows the number of corners in each cell. The title tells how many
// photographs show a piece of the board.
std::string coverage_svg(const Calibration& calibration);

}  // namespace axial::calibrate
