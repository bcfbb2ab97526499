// SPDX-License-Identifier: GPL-3.0-or-later
// stb's rectangle packer, whose code is compiled in one place.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>

namespace axial::texture {

// A rectangle to place.
struct StbRect {
  cv::Size size;                    // [px], sides at least 1
  std::optional<cv::Point> corner;  // upper left pixel; empty: not placed
};

// Places rectangles in a texture of the size `texture` [px]. Sets StbRect::corner of the rectangles
// for which the packer finds a place, and leaves the other rectangles unchanged. The first
// rectangle is placed in the upper left corner of the texture if it fits.
void pack_with_stb(cv::Size texture, std::span<StbRect> rects);

}  // namespace axial::texture
