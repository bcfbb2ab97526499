// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: the pose of each photograph relative to the board, without an initial
// guess.
#pragma once

#include "pose/bundle.h"

namespace axial::calibrate {

// Sets the poses of `bundle`'s images so that the board's corners fit best, with the port as it is.
// First solves a perspective pose problem for the rays in water, as if they met in one point; then
// adjusts the pose by exact projection. The perspective problem of a plane may have two similar
// solutions, and both are tried. Images whose corners do not determine a pose keep their pose and
// lose their observations.
void place_boards(pose::Bundle& bundle);

}  // namespace axial::calibrate
