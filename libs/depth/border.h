// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of a depth map near image borders. The correlation of a matching window that lies
// partly outside an image uses fewer texels, so windows at wrong depths correlate by chance more
// often. Propagation spreads these wrong depths to nearby pixels, whose windows lie inside the
// image.
#pragma once

#include <opencv2/core.hpp>

#include "depth/patch/reference_patch.h"
#include "depth/patch_match.h"
#include "scene/depth_map.h"

namespace axial::depth {

// The distance [px] from an image border below which a pixel is near the border. In the test
// through a water surface (tests/apps/end_to_end_test.py), a distance of only kPatchRadius left a
// patch of wrong depths 14 pixels wide.
inline constexpr int kBorderWidth = 3 * kPatchRadius;

// The side [px] of the square blocks into which border_pixels() divides the map. All pixels of a
// block share one projection into the source views, because projections take most of the time.
inline constexpr int kBorderBlock = 4;

// Returns 255 for pixels near borders, 0 elsewhere. The result is 0 for a pixel without a depth.
// A pixel with a depth is near a border in two cases. In the first case, it lies less than
// kBorderWidth from the border of the reference image. In the second case, no source view shows
// the surface point of the pixel's block at least kBorderWidth from the border of the source
// image. The surface point of a block is the point of the first pixel with a depth in the block,
// row by row. Without source views, every pixel with a depth is near a border. The result has the
// size of `map`. `map`: the depth map of input.reference. Throws an Error if input.projection does
// not support the cameras. Precondition: `map` has the size of input.reference->grey.
cv::Mat1b border_pixels(const MatchInput& input, const DepthMap& map);

}  // namespace axial::depth
