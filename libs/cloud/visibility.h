// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene's points look like to the images that see them.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace axial::cloud {

// For every point how much speaks for it. From each view of each point p a cone of one pixel opens
// towards it. Points in the cone that are farther than p, by more than 1 %, gain their own number
// of views; points that are nearer by more than 1 % lose p's number of views, because p is seen
// through them. Error for views of images that do not exist.
std::vector<long> visibility_of_points(const Scene& scene);

struct PointScale {
  float scale = 0;       // width of a pixel at the point, mean over its views [scene units]
  float confidence = 0;  // sum of its views' confidences; their number where these are all 0
};

// Points that no calibrated image sees get 0 and 0.
std::vector<PointScale> scales_of_points(const Scene& scene);

}  // namespace axial::cloud
