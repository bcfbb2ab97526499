// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: the pose of each photograph relative to the board, without an initial
// guess.
#pragma once

#include "pose/bundle.h"

namespace axial::calibrate {

// Sets the poses of the images of `bundle` so that the board's corners fit best. The port is not
// changed. First the rays in water are treated as if they met in one point, and a perspective pose
// problem is solved. A plane may have two similar perspective poses. In this case both are tried.
// Then the pose is adjusted by exact projection. An image whose corners do not determine a pose
// keeps its pose and loses its observations.
void place_boards(pose::Bundle& bundle);

}  // namespace axial::calibrate
