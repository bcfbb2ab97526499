// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility and scale of the sparse points in the images that see them.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace axial::cloud {

// A score per point of scene.points: the higher, the more other observations support the point.
// Each view of each point p defines a cone through p with a diameter of one pixel. A point in the
// cone whose depth is more than 1 % larger than that of p gains its own number of views. A point
// whose depth is more than 1 % smaller loses the number of views of p, because p is seen through
// it. Throws an Error for views of images that do not exist.
std::vector<long> visibility_of_points(const Scene& scene);

struct PointScale {
  float scale = 0;       // width of a pixel at the point, mean over its views [scene units]
  float confidence = 0;  // sum of the confidences of its views; if all are 0, the number of views
};

// One PointScale per point of scene.points. Points that no calibrated image sees get 0 and 0.
// Throws an Error for views of images that do not exist.
std::vector<PointScale> scales_of_points(const Scene& scene);

}  // namespace axial::cloud
