// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how evenly a cloud covers the ground along one strip of cameras.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "evaluate/places.h"
#include "evaluate/views.h"

namespace axial::evaluate {

// A piece of the strip. All pieces have the same length.
struct StripPiece {
  double begin = 0, end = 0;  // along the strip, from the first camera [m]
  std::size_t points = 0, places = 0;
};

struct Strip {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // unit
  std::vector<StripPiece> pieces;
  // Density (points per counted place) of the emptiest and of the fullest piece, divided by the
  // mean density of the strip.
  double least = 0, most = 0;
};

// Error unless there are at least three views whose centres lie on a line, up to a width of a
// quarter of its length.
void require_strip(std::span<const View> views);

// Cuts the strip into pieces and counts points and places in them. The strip runs along the
// greatest extent of the camera centres, over the whole extent of the places. There are five pieces
// for each spacing between views. Pieces with fewer than half of the places of the median piece are
// left out of `least` and `most`; they are the ends of the strip. Error as for require_strip, or
// for views that are nearly at one place.
Strip density_along_strip(std::span<const Eigen::Vector3f> points, const Places& places,
                          std::span<const View> views);

}  // namespace axial::evaluate
