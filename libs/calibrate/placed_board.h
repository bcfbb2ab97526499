// SPDX-License-Identifier: GPL-3.0-or-later
// Possible photographs of a board.
#pragma once

#include <string>
#include <vector>

#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// A place of the board before the camera.
struct PlacedBoard {
  int column = 0, row = 0;  // in the image: -1 left or top edge, 0 middle, 1 right or bottom
  double distance = 0;      // of the board's middle along the optical axis [m]
  int turned = 0;           // 0: faces the camera; -1, 1: left, right side nearer
  int tipped = 0;           // -1, 1: upper, lower side nearer
  Pose pose;
  std::vector<Corner> corners;  // all corners of the board, in the photograph
};

// All placements at which the photograph shows the whole board with its `corners` [m]: at each
// edge, each corner and in the middle of the image; 0.8 and 0.4 times as wide or high as the image,
// but not nearer than `least_distance` [m]; facing the camera, and turned by 35 degrees.
std::vector<PlacedBoard> placed_boards(const pose::ColmapBundle& bundle,
                                       std::span<const Eigen::Vector3d> corners,
                                       double least_distance);

// The placement in words: "the board at the image's left edge, 0.30 m away, facing the camera".
std::string words_for(const PlacedBoard& placed);

}  // namespace axial::calibrate
