// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a board that could be taken.
#pragma once

#include <string>
#include <vector>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// How to hold the board.
struct PlacedBoard {
  int column = 0, row = 0;  // of the image: -1 at its left or top edge, 0 in the middle, 1
  double distance = 0;      // of the board's middle along the camera's z axis [m]
  int turned = 0;           // 0: faces the camera; -1, 1: its left, its right side is nearer
  int tipped = 0;           // -1, 1: its upper, its lower side is nearer
  Pose pose;
  std::vector<Corner> corners;  // where the photograph would show them: all of the board's
};

// All ways to hold the board of `corners` that the photograph shows whole: at each edge, each
// corner and in the middle of the image; as large as fits and half of that, but no nearer than
// `least_distance` [m]; facing the camera, and turned by 35 degrees.
std::vector<PlacedBoard> placed_boards(const pose::ColmapBundle& bundle,
                                       std::span<const Eigen::Vector3d> corners,
                                       double least_distance);

// "the board at the image's left edge, 0.30 m away, its upper side nearer by 35 degrees".
std::string words_for(const PlacedBoard& placed);

}  // namespace axial::calibrate
