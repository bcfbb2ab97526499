// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: circular targets in a photograph.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "targets/codes/family.h"
#include "targets/fits/detection.h"

namespace axial::targets {

// Finds the targets of `family`, of kind ring, in `grey` (0 to about 255): white on black, and
// black on white. A target may be found several times.
std::vector<Detection> find_rings(const cv::Mat1f& grey, const Family& family);

}  // namespace axial::targets
