// SPDX-License-Identifier: GPL-3.0-or-later
// Finds a board in a photograph.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// Returns the corners of the board in a grey photograph, to fractions of a pixel. Boards may be
// visible in part. If no whole checkerboard is found, the view has the corners of the largest
// piece of a checkerboard (View::piece). The piece must have 12 corners or more, and at least 3
// columns and 3 rows of them. Without the board or such a piece, the view has no corners, and
// View::fault says why. `name`: View::image of the result. Precondition: `board` is a result of
// parse_board().
View see_board(const std::string& name, const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::calibrate
