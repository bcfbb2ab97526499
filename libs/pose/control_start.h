// SPDX-License-Identifier: GPL-3.0-or-later
// The start of an adjustment with known places: where the model is in the world.
#pragma once

#include <string>
#include <vector>

#include "pose/adjust.h"

namespace axial::pose {

// Moves the bundle to its known places, as a start for adjust(). Wholly known places, at least
// three and not on a line, place it by a similarity, without those that do not fit
// (robust_similarity()). Otherwise:
// - Three or more known heights, not above a line, turn the model upright. With fewer, the mean
//   viewing direction of the images points down.
// - Two or more places with known x and y turn the model about the vertical and shift it, and scale
//   it if `options` has no distances. One such place shifts it.
//   In the plane the model is only turned and scaled, so that it cannot turn over.
// - Known heights shift it along the vertical.
void place_by_control(Bundle& bundle, const AdjustOptions& options);

// Returns a line if the places state that the model is upside down, which northing before easting
// or depths instead of heights cause: the cameras look upwards after place_by_control(), or the
// mirror image of the model fits the places better. Empty if there is no sign of this.
std::vector<std::string> signs_of_a_mirror(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
