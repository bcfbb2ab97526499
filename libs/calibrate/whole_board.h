// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: whole checkerboards, by OpenCV's detectors.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "calibrate/board.h"

namespace axial::calibrate {

// Both functions return all corners of a checkerboard, row by row. If a detector does not find all
// of them, or guesses the place of a hidden corner, the result is empty. Precondition: `board` is a
// checkerboard.
std::vector<Corner> find_whole_board(const cv::Mat1b& photograph, const Board& board);
// Also finds boards that have hardly any margin. Takes minutes for some large photographs.
std::vector<Corner> find_board_without_margin(const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::calibrate
