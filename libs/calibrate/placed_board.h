// SPDX-License-Identifier: GPL-3.0-or-later
// Possible photographs of a board.
#pragma once

#include <string>
#include <vector>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// A place of the board in front of the camera.
struct PlacedBoard {
  int column = 0, row = 0;  // in the image: -1 left or top edge, 0 middle, 1 right or bottom
  double distance = 0;      // of the board's middle along the optical axis [m]
  int turned = 0;           // -1: the left side is nearer, 1: the right side; 0: neither
  int tipped = 0;           // -1: the upper side is nearer, 1: the lower side; 0: neither
  Pose pose;
  std::vector<Corner> corners;  // all corners of the board, in the photograph
};

// Returns the placements at which the photograph shows the whole board with its `corners` [m]. All
// combinations of the following are tried:
//
// * nine places in the image: at each edge, in each corner and in the middle.
// * two distances: a board that faces the camera is 0.8 or 0.4 times as wide or as high as the
//   image. A distance below `least_distance` [m] is raised to `least_distance`.
// * five orientations: facing the camera, and with the left, right, upper or lower side nearer by a
//   turn of 35 degrees.
std::vector<PlacedBoard> placed_boards(const pose::ColmapBundle& bundle,
                                       std::span<const Eigen::Vector3d> corners,
                                       double least_distance);

// Describes the placement: "the board at the image's left edge, 0.30 m away, facing the camera".
std::string words_for(const PlacedBoard& placed);

}  // namespace axial::calibrate
