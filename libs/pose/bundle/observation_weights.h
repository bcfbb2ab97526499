// SPDX-License-Identifier: GPL-3.0-or-later
// How accurate observations are, by the sizes of their features.
#pragma once

#include "pose/bundle/bundle.h"

namespace axial::pose {

// Sets Observation::sigma. The place of a feature is known about in proportion to its size: among
// the features of one dive, the median error grows by a factor of three from the finest to the
// coarsest eighth. The observations with a known size (Observation::size) are sorted by size into
// up to eight classes of equal numbers, of at least 200 observations each. The relative standard
// deviation of a class is the median of its reprojection errors, divided by the median of all: at
// least 1/4 and at most 4. Without errors above 0, with fewer than two classes, or without a known
// size it is 1.
void weigh_by_size(Bundle& bundle);

// Multiplies Observation::sigma of features by their relative standard deviation at their distance
// from the principal point, in the same classes of equal numbers: a flat port blurs the rim of the
// photograph. The errors count in units of the present Observation::sigma, so that only the part is
// found that sizes of features do not explain.
void weigh_by_radius(Bundle& bundle);

}  // namespace axial::pose
