// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility and scale of the sparse points in the images that see them.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace axial::cloud {

// Returns a score for each point of scene.points, in their order. Scores start at 0 and may become
// negative. For each point p, each calibrated image that sees p, and each other point q of the
// scene whose projection into the image is at most half a pixel from the projection of p, the
// depths of p and q along their rays are compared. The image need not see q.
// - If q is more than 1 % farther than p, the score of q rises by the number of views of q.
// - If q is more than 1 % nearer than p, the score of q falls by the number of views of p, because
//   the image sees p through q.
// Points that do not project into an image are skipped there. Throws an Error for views of images
// that do not exist.
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
