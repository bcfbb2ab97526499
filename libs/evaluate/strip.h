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
  double begin = 0, end = 0;           // positions along the strip [m]; views[0] is at 0
  std::size_t points = 0, places = 0;  // number of points and of places from `begin` to `end`
};

struct Strip {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // unit, in the frame of the views
  std::vector<StripPiece> pieces;                       // in the order of their positions
  // The density of a piece is its number of points per place. The mean density is the number of
  // points in all pieces that count, per place in these pieces. `least` and `most` are the smallest
  // and the largest density of these pieces, divided by the mean density. They are 0 if the pieces
  // contain no points. density_along_strip() defines which pieces count.
  double least = 0, most = 0;
};

// Error unless there are at least three views and their centres form a strip, which means that the
// relative_width() of the centres (scene/decompositions.h) is at most 1/4.
void require_strip(std::span<const View> views);

// Cuts the strip into pieces and counts the points and places in each piece. The direction of the
// strip is the principal axis along which the camera centres extend most. It points from the camera
// centre of views[0] towards the mean of the centres. The strip covers the whole extent of the
// places in this direction. Points beyond the strip do not count. The length of a piece is at most
// 1/5 of the mean spacing of the views. For Strip::least and Strip::most, a piece counts if it has
// a place, and at least half as many places as the median piece. The other pieces usually lie at
// the ends of the strip. Precondition: there is at least one place. Error as for require_strip(),
// or if the views are so close together that more than 1e5 pieces would be needed.
Strip density_along_strip(std::span<const Eigen::Vector3f> points, const Places& places,
                          std::span<const View> views);

}  // namespace axial::evaluate
