// SPDX-License-Identifier: GPL-3.0-or-later
// Removes unreliable depths where the photograph shows little more than the camera's noise, for
// example on sand, in haze and in open water. Removes unreliable depths at image borders, too
// (border.h).
#pragma once

#include <opencv2/core.hpp>

#include "scene/depth_map.h"

namespace axial::depth {

struct WeakTextureOptions {
  // Texture is weak if the standard deviation of the grey levels (0 to 255) in a 9x9 window is
  // below this value.
  float deviation = 1.5f;
  // An unsure depth (see remove_unconfirmed()) is kept if the mean confidence of the unsure depths
  // in the 9x9 window around it is at least this value. On the preset `sand` of SimulateUnderwater,
  // this mean is at least 0.68 in 95 % of the windows. With a twentieth of the texture of `sand`,
  // the mean is below 0.62 in half of the windows.
  float least_confidence = 0.6f;
};

// A depth is unsure if its pixel has weak texture or is near a border. Sets the depth, normal and
// confidence of a pixel with an unsure depth to 0 if the mean confidence of all unsure depths in
// the 9x9 window around it is below least_confidence. The window includes the pixel itself. The
// confidence of a single pixel is not enough for this decision, because the best of many planes
// correlates even with noise. `grey`: the image of the map; throws an Error if it does not have the
// map's size. `border`: border_pixels() of the map; empty: no pixel is near a border. Precondition:
// `border` is empty or has the map's size. A map without confidences is returned unchanged, with
// shared pixels. In other cases, the result has its own pixels.
DepthMap remove_unconfirmed(const DepthMap& map, const cv::Mat1b& grey,
                            const cv::Mat1b& border = cv::Mat1b(),
                            const WeakTextureOptions& options = {});

}  // namespace axial::depth
