// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of a depth map near image borders. A matching window that leaves an image correlates
// over fewer texels, so windows at wrong depths correlate by chance more often. Propagation spreads
// such depths to the pixels beside them, whose windows are whole.
#pragma once

#include <opencv2/core.hpp>

#include "depth/patch_match.h"
#include "scene/depth_map.h"

namespace axial::depth {

// Three times the radius of the matching window [px]. With the radius alone, a patch of wrong
// depths 14 pixels wide remained in a test through a water surface.
inline constexpr int kBorderWidth = 12;

// Returns 255 for pixels near borders, 0 elsewhere. A pixel with a depth is near a border if it
// lies less than kBorderWidth from the border of the reference image, or if every source view shows
// its surface point less than kBorderWidth from the source image's border or not at all. `map`: the
// depth map of input.reference. Precondition: the map has the size of its image.
cv::Mat1b border_pixels(const MatchInput& input, const DepthMap& map);

}  // namespace axial::depth
