// SPDX-License-Identifier: GPL-3.0-or-later
// Finds coded targets in photographs. Start here to read libs/targets.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "targets/codes/family.h"
#include "targets/fits/detection.h"

namespace axial::targets {

// The memory that find_targets() needs beside the photograph [bytes], for a photograph of this
// size.
std::uint64_t bytes_of_search(cv::Size size);

// Finds the targets of `families` in a photograph of 8 or 16 bits (CV_8U or CV_16U), B G R or grey.
// Precondition: it is not empty. The values of 16 bits may use fewer bits. Circular targets are
// found as white on black and as black on white, square markers as they are printed. Each target is
// found once; of two places with one label both are returned, because two plates with one code are
// a fault that the caller names. The order is that of `families`, then that of the numbers, then
// from top to bottom. A target is found only if all of it is in the photograph.
std::vector<Detection> find_targets(const cv::Mat& photograph, std::span<const Family> families);

}  // namespace axial::targets
