// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: square markers in a photograph.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "targets/codes/family.h"
#include "targets/fits/detection.h"

namespace axial::targets {

// Finds the markers of `family`, of kind square, in `grey` (0 to 255). A marker may be found
// several times.
std::vector<Detection> find_squares(const cv::Mat1f& grey, const Family& family);

}  // namespace axial::targets
