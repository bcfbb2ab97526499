// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: decides which way round a board of squares that are not square is.
#pragma once

#include <span>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// Exchanges View::corners and View::turned of each view that has both, if the corners of
// View::turned have the smaller reprojection errors. The errors are those of the best pose for
// `lens` behind `port`. `corners`: the corners of the board [m]. Returns true if a view changed.
bool choose_turns(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                  std::span<View> views, std::span<const Eigen::Vector3d> corners);

}  // namespace axial::calibrate
