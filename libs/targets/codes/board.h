// SPDX-License-Identifier: GPL-3.0-or-later
// Boards: flat targets with many corners.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "targets/codes/board_shape.h"

namespace axial::targets {

// Reads a board from a text of one of these forms:
//
//     checkerboard:COLUMNSxROWS:SQUARE                     inner corners
//     checkerboard:COLUMNSxROWS:WIDTH,HEIGHT               prints are not always square
//     charuco:COLUMNSxROWS:SQUARE:MARKER[:DICTIONARY]      squares; default 4X4_50
//     apriltags:COLUMNSxROWS:TAG:GAP[:DICTIONARY]          tags; default APRILTAG_36h11
//
// COLUMNS and ROWS are from 3 to 100 (tags: from 1 to 100). Lengths are in metres, above 0 and at
// most 10. MARKER must be smaller than SQUARE. WIDTH and HEIGHT must not differ by a factor of more
// than 1.5. The dictionary must have enough markers, which are
// numbered from 0, row by row. If `text` does not comply, throws an Error that contains `text` and
// the reason.
Board parse_board(const std::string& text);

// True for a checkerboard whose squares are not square: it looks different after a quarter of a
// turn, however many columns and rows it has.
bool has_two_pitches(const Board& board);

// All corners [m] in the frame of the board. The index of a corner is its Corner::number.
// Precondition: `board` is a result of parse_board().
// - Checkerboard: the inner corners, row by row. The first is the origin.
// - ChArUco: the inner corners of the squares, row by row. The first is (size, size, 0).
// - AprilTags: the four corners of each tag, around the tag; the tags row by row. The first corner
//   of the first tag is the origin, the second is (size, 0, 0), the third is (size, size, 0).
std::vector<Eigen::Vector3d> corners_of(const Board& board);

}  // namespace axial::targets
