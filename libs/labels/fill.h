// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/polygon_pieces.h"

namespace axial::labels {

// Sets the pixels whose centres lie in the parts to `value`.
void fill(const std::vector<std::vector<geometry::Ring>>& parts, std::uint16_t value,
          cv::Mat1w& mask);

}  // namespace axial::labels
