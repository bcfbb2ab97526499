// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility and scale of the sparse points in the images that see them.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace axial::cloud {

// Returns a score for each point of scene.points, in their order. The more other observations
// support a point, the higher its score. The scores start at 0 and are changed for each point p and
// each view of p in a calibrated image. The view defines a cone of rays through p with a diameter
// of one pixel of this image. Let q be another point in the cone; depths are measured along the
// rays. If the depth of q is more than 1 % larger than the depth of p, the score of q rises by the
// number of views of q. If the depth of q is more than 1 % smaller, the score of q falls by the
// number of views of p, because p is seen through q. Throws an Error for views of images that do
// not exist.
std::vector<long> visibility_of_points(const Scene& scene);

// The size of a point in the images that see it.
struct PointScale {
  float scale = 0;  // mean width of a pixel at the point over its views [unit of the scene]
  // The sum of SparseView::confidence over its views. If this sum is 0: the number of calibrated
  // images that see the point.
  float confidence = 0;
};

// Returns one PointScale per point of scene.points, in their order. A point that no calibrated
// image sees gets scale 0 and confidence 0. Throws an Error for views of images that do not exist.
std::vector<PointScale> scales_of_points(const Scene& scene);

}  // namespace axial::cloud
