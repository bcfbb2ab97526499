// SPDX-License-Identifier: GPL-3.0-or-later
// The start of an adjustment with known places: where the model is in the world.
#pragma once

#include "pose/adjust.h"

namespace axial::pose {

// True if known lengths or places determine the scale of a bundle: `options` has a distance, or
// places of which two or more have the same two known coordinates, or three or more are wholly
// known.
bool determine_scale(const AdjustOptions& options);

// Moves the bundle to its known places, as a start for adjust(). Wholly known places, at least
// three and not on a line, place it by a similarity, without those that do not fit
// (robust_similarity()). Otherwise:
// - Three or more known heights, not above a line, turn the model upright. With fewer, the mean
//   viewing direction of the images points down.
// - Two or more places with known x and y turn the model about the vertical and shift it, and scale
//   it if `options` has no distances. One such place shifts it.
// - Known heights shift it along the vertical.
void place_by_control(Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
