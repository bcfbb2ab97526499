// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Fills cloud.colors. Every point gets its colour from the view with the smallest positive z-depth
// (the first of equal ones), by bilinear interpolation at the exact projection. A point without
// such a view, or with a projection outside the image, becomes white. `load_color(i)` returns image
// i of the scene in B G R, at any size. It is called from one thread, at most once per image.
// Throws an Error for a cloud without views, for views of images that do not exist, and for an
// empty image.
void estimate_colors(PointCloud& cloud, const Scene& scene,
                     const std::function<cv::Mat3b(std::size_t image)>& load_color);

}  // namespace axial::cloud
