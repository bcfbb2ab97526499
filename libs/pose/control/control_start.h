// SPDX-License-Identifier: GPL-3.0-or-later
// The start of an adjustment with known places: where the model is in the world.
#pragma once

#include <string>
#include <vector>

#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// Moves the bundle to its known places, as a start for adjust(). Wholly known places, at least
// three and not on a line, place it by a similarity, without those that do not fit
// (robust_similarity()). Otherwise:
// - Three or more known heights, not above a line, turn the model upright. With fewer, the mean
//   viewing direction of the images points down.
// - Two or more places with known x and y turn the model about the vertical and shift it, and scale
//   it if `options` has no distances. One such place shifts it. These motions keep the vertical, so
//   that the model cannot turn over.
// - Known heights shift it along the vertical.
void place_by_control(Bundle& bundle, const AdjustOptions& options);

// Returns a line if the mirror image of the model fits the wholly known places better, or if they
// place the model so that the cameras look upwards. Two wrong inputs cause this: northing before
// easting, and depths instead of heights. Returns nothing otherwise, and if the wholly known places
// do not determine a similarity. Precondition: place_by_control() or adjust() placed the bundle.
std::vector<std::string> signs_of_a_mirror(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
