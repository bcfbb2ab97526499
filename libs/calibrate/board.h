// SPDX-License-Identifier: GPL-3.0-or-later
// Flat calibration targets. see_board.h finds them in photographs.
#pragma once

#include "targets/codes/board.h"

namespace axial::calibrate {

using targets::Board;
using targets::BoardKind;
using targets::Corner;
using targets::corners_of;
using targets::has_two_pitches;
using targets::parse_board;

}  // namespace axial::calibrate
