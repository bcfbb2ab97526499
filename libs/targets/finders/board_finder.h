// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: the corners of a ChArUco board in a photograph.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "targets/codes/family.h"
#include "targets/fits/detection.h"

namespace axial::targets {

// Finds the inner corners of the board of `family`, of kind board, in `grey` (0 to 255). The board
// may be visible in part. A corner is found if another one in its row and one in its column are.
std::vector<Detection> find_board_corners(const cv::Mat1f& grey, const Family& family);

}  // namespace axial::targets
