// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of a depth map near image borders. A matching window that leaves an image correlates
// over fewer texels, so windows at wrong depths correlate by chance more often. Propagation spreads
// such depths to the pixels beside them, whose windows are whole.
#pragma once

#include <opencv2/core.hpp>

#include "depth/patch_match.h"
#include "depth/reference_patch.h"
#include "scene/depth_map.h"

namespace axial::depth {

// [px]. With the radius of the window alone, a patch of wrong depths 14 pixels wide remained in the
// test through a water surface (tests/apps/end_to_end_test.py).
inline constexpr int kBorderWidth = 3 * kPatchRadius;

// Pixels of a block of kBorderBlock x kBorderBlock pixels share one projection into the source
// views, which takes most of the time.
inline constexpr int kBorderBlock = 4;

// Returns 255 for pixels near borders, 0 elsewhere. A pixel with a depth is near a border if it
// lies less than kBorderWidth from the border of the reference image, or if no source view shows
// the surface point of its block at least kBorderWidth from the border of the source image. The
// surface point of a block is the point of its first pixel with a depth, row by row. `map`: the
// depth map of input.reference. Throws an Error if input.projection does not support the cameras.
// Precondition: the map has the size of its image.
cv::Mat1b border_pixels(const MatchInput& input, const DepthMap& map);

}  // namespace axial::depth
