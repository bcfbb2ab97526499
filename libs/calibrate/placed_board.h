// SPDX-License-Identifier: GPL-3.0-or-later
// Possible photographs of a board.
#pragma once

#include <string>
#include <vector>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// A place of the board in front of the camera. Sides are those that the photograph shows: left,
// right, upper, lower.
struct PlacedBoard {
  // Place in the image: -1 left or upper edge, 0 middle, 1 right or lower edge.
  int column = 0, row = 0;
  double distance = 0;          // z of the board's middle in the camera's frame [m]
  int turned = 0;               // -1: the left side is nearer, 1: the right side; 0: neither
  int tipped = 0;               // -1: the upper side is nearer, 1: the lower side; 0: neither
  Pose pose;                    // of the camera, in the frame of the board
  std::vector<Corner> corners;  // all corners of the board, in the photograph, by number
};

// Returns the placements at which the photograph shows the whole board with its `corners` [m, frame
// of the board]. The camera is the first camera of `bundle`. All combinations of the following are
// tried:
//
// * nine places in the image: at each edge, in each corner and in the middle.
// * two distances: a board that faces the camera takes 0.8 or 0.4 of the width or of the height of
//   the image, and no larger share of the other. A distance below `least_distance` [m] is raised to
//   `least_distance`.
// * five orientations: facing the camera, and with the left, right, upper or lower side nearer by a
//   turn of 35 degrees.
//
// A combination is left out if the board does not fit into the image. The order of the results
// depends on the arguments alone.
std::vector<PlacedBoard> placed_boards(const pose::ColmapBundle& bundle,
                                       std::span<const Eigen::Vector3d> corners,
                                       double least_distance);

// Describes the placement in English: "the board at the image's left edge, 0.30 m away, facing the
// camera".
std::string words_for(const PlacedBoard& placed);

}  // namespace axial::calibrate
