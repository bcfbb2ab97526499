// SPDX-License-Identifier: GPL-3.0-or-later
// How evenly a cloud covers the ground along one strip of cameras.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "evaluate/places.h"
#include "evaluate/views.h"

namespace axial::evaluate {

// Of an equal length of the strip.
struct StripPiece {
  double begin = 0, end = 0;  // along the strip, from the first camera [m]
  std::size_t points = 0, places = 0;
};

struct Strip {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // unit
  std::vector<StripPiece> pieces;
  // Points per area of counted truth, over their mean along the strip: of the emptiest and of the
  // fullest piece.
  double least = 0, most = 0;
};

// Error unless there are three views, in a line to a quarter of its length.
void require_strip(std::span<const View> views);

// The strip lies along the greatest extent of the camera centres, from end to end of the places,
// and is cut into five pieces a view spacing. Pieces with less than half of the places of the
// median piece do not count in `least` and `most`: ends of the strip. Error as require_strip.
Strip density_along_strip(std::span<const Eigen::Vector3f> points, const Places& places,
                          std::span<const View> views);

}  // namespace axial::evaluate
