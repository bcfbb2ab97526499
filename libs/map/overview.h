// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

namespace axial::map {

struct OverviewFacts {
  double pixel = 1;               // width of a pixel of the picture [m]
  bool is_georeferenced = false;  // y of the map is north
};

// The picture (B G R) of a map for people who have no program for maps. `colors`: R G B alpha.
// Places without colour are white. A strip of 56 pixels below the map holds a scale bar, whose
// length is 1, 2 or 5 times a power of ten in metres and at most a third of the picture's width,
// and an arrow in the direction of the map's y axis. The arrow has the letter N if the map is
// georeferenced, and y otherwise. A map narrower than 200 pixels gets a white border at its right.
cv::Mat3b draw_overview(const cv::Mat4b& colors, const OverviewFacts& facts);

// The length [m] of the scale bar of a picture whose width is `width` metres.
double scale_bar_length(double width);

}  // namespace axial::map
