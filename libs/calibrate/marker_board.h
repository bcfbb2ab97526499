// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: boards of markers, by OpenCV's aruco module.
#pragma once

#include <string>
#include <vector>

#include "calibrate/board.h"

namespace axial::calibrate {

// Error that starts with `where` for a dictionary OpenCV does not have, or one with too few
// markers.
void check_markers(const Board& board, const std::string& where);

// As corners_of and find_corners, for boards of markers.
std::vector<Eigen::Vector3d> marker_board_corners(const Board& board);
std::vector<Corner> find_marker_corners(const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::calibrate
