// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets and libs/calibrate: boards of markers, with OpenCV's aruco module.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "targets/codes/board_shape.h"

namespace axial::targets {

// Precondition: `board` is a ChArUco board or a board of AprilTags. Throws an Error that starts
// with `where` if OpenCV does not have the dictionary of `board`, or if the dictionary has too few
// markers for `board`.
void check_markers(const Board& board, const std::string& where);

// Returns what corners_of() (board.h) returns for a ChArUco board or a board of AprilTags.
// Precondition: check_markers() accepts `board`.
std::vector<Eigen::Vector3d> marker_board_corners(const Board& board);
// Returns the visible corners, in any order. The precondition is the same.
std::vector<Corner> find_marker_corners(const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::targets
