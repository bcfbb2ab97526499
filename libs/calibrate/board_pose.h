// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: the pose of each photograph relative to the board, without an initial
// guess.
#pragma once

#include "pose/bundle/bundle.h"

namespace axial::calibrate {

// Sets the pose of each image of `bundle`, a bundle of board_bundle(), to the pose for which the
// board's corners have the smallest reprojection errors (Huber loss). The old poses are not used,
// and the port is not changed. An image whose corners do not determine a pose keeps its pose and
// loses its observations: it has fewer than 4 corners, they lie on a line, or the adjustment fails.
// First the rays in water are treated as if they met in one point, and a perspective pose problem
// is solved. A plane may have two similar perspective poses. Each of them is adjusted by exact
// projection, and the pose with the smaller errors is kept.
void place_boards(pose::Bundle& bundle);

}  // namespace axial::calibrate
