// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: checkerboards that a photograph shows in part.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "calibrate/board.h"

namespace axial::calibrate {

// The part of a checkerboard that a photograph shows.
struct Piece {
  int columns = 0, rows = 0;  // the extent of the corners along both directions
  // The corners, numbered as if the piece lay at the first corner of the board. Where the piece
  // lies on the board is not known.
  std::vector<Corner> corners;
  // The same corners with their numbers after a quarter of a turn. Empty unless both ways to number
  // them are possible and differ: the piece fits on the board in both ways, and the squares of the
  // board are not square.
  std::vector<Corner> turned;

  // True if the piece has at least 12 corners, and at least 3 columns and 3 rows of them.
  bool suffices() const;
};

// Finds the largest piece of a checkerboard: corners that are connected by visible edges. Hands,
// glare and the borders of the photograph may hide the rest of the board. Corners whose
// surroundings are hidden in part are left out, because what hides them would move them. The result
// has no corners if the photograph shows no piece with four corners of a square. Precondition:
// `board` is a checkerboard.
Piece find_piece(const cv::Mat1b& photograph, const Board& board);

// Returns the `corners` of a whole checkerboard with their numbers after a quarter of a turn. Empty
// unless both ways to number them are possible and differ. Precondition: `board` is a checkerboard.
std::vector<Corner> turned_board(const Board& board, const std::vector<Corner>& corners);

}  // namespace axial::calibrate
