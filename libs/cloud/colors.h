// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Fills cloud.colors. The colour of a point comes from that of its views in which the point has the
// smallest positive z-depth. If several views have this z-depth, the first of them in the point's
// list is taken. The point is projected exactly into the image of this view, and the colour is
// interpolated bilinearly. A point becomes white if it has no view with positive z-depth, or if its
// projection is outside the image. Existing colours are replaced.
// `load_color(i)` returns image i of the scene in B G R, at any size; it is called from one thread,
// at most once per image, and only for images that are needed. Throws an Error for a cloud without
// views, for views of images that do not exist, and for an empty image.
void estimate_colors(PointCloud& cloud, const Scene& scene,
                     const std::function<cv::Mat3b(std::size_t image)>& load_color);

}  // namespace axial::cloud
