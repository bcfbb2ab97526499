// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "axial/compare.h"

namespace axial::compare {

// The picture (B G R) of a comparison, reduced to single pixels of the maps so that it has at most
// `longest_side` pixels along each side, besides its strips. Unchanged ground is grey, with the
// relief of the earlier survey under a light from the upper left. What came is blue and what went
// is orange, the darker the larger the difference. Places that are not compared are white. Strips
// below the map have a scale bar, an arrow in the direction of the map's y axis (N if
// `is_georeferenced`), and a legend of the colours.
cv::Mat3b draw_changes(const Comparison& comparison, bool is_georeferenced,
                       int longest_side = 2048);

// The difference [m] of the darkest colour: the absolute difference that 2 % of the changed pixels
// exceed. 0 without changes.
double darkest_difference(const Comparison& comparison);

}  // namespace axial::compare
