// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: where the board was in a photograph of which nothing else is known.
#pragma once

#include "pose/bundle.h"

namespace axial::calibrate {

// Sets the poses of `bundle`'s images to where their corners fit best behind the port as it is: by
// perspective of the rays in water, as though they met in one point, then by exact projection. A
// plane may look nearly the same from two sides; both are tried. Images whose corners do not tell
// where the board is keep their pose and lose their observations.
void place_boards(pose::Bundle& bundle);

}  // namespace axial::calibrate
