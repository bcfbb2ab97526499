// SPDX-License-Identifier: GPL-3.0-or-later
// stb's rectangle packer, whose code is compiled in one place.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>

namespace axial::texture {

struct StbRect {
  cv::Size size;
  std::optional<cv::Point> corner;  // nothing: does not fit
};

// Places as many of the rectangles as fit into a texture. The first one lies in its corner.
void pack_with_stb(cv::Size texture, std::span<StbRect> rects);

}  // namespace axial::texture
