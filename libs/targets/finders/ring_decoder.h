// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: reads the ring around a dot.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "targets/codes/pattern.h"
#include "targets/fits/dot_fit.h"

namespace axial::targets {

struct RingReading {
  std::uint32_t value = 0;  // the bits of the segments, from segment 0 in the lowest bit
  double phase = 0;         // where segment 0 begins [rad, in the plane of Ellipse::to_circle]
  RingRadii radii;          // measured in the picture
};

// Reads the ring of `bits` segments around `dot`. `picture` shows a white dot on black. Nothing
// unless the gap around the dot is dark in all directions, and the ring has bright and dark
// segments whose borders lie on a grid of `bits` segments.
std::optional<RingReading> read_ring(const cv::Mat1f& picture, const Ellipse& dot, int bits);

}  // namespace axial::targets
