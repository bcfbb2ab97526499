// SPDX-License-Identifier: GPL-3.0-or-later
// Depths where the photograph shows little more than the camera's noise: sand, haze, open water.
#pragma once

#include <opencv2/core.hpp>

#include "scene/depth_map.h"

namespace axial::depth {

struct WeakTextureOptions {
  float deviation = 1.5f;  // of a 9x9 window's grey levels, below which its texture is weak
  // Mean confidence of the pixels with weak texture in a 9x9 window. In
  // SimulateUnderwater's preset sand 95 % of the windows have 0.68 or more; with a texture of a
  // twentieth of that, half of them have less than 0.62.
  float least_confidence = 0.6f;
};

// Clears depths of weak texture that the photographs do not confirm: those around which the pixels
// with a depth and weak texture have too little confidence in the mean. One pixel cannot tell: the
// best of many planes correlates even with noise. `grey`: the map's image, of the map's size (Error
// otherwise). A map without confidence is returned as it is.
DepthMap remove_unconfirmed(const DepthMap& map, const cv::Mat1b& grey,
                            const WeakTextureOptions& options = {});

}  // namespace axial::depth
