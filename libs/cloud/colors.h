// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Colours every point from the nearest of its views (ties: the first), bilinearly at the exact
// projection; white where that lies outside the image. `load_color(i)` gives image i of the scene
// in B G R at any size; it is called from one thread, at most once an image. Error for a cloud
// without views.
void estimate_colors(PointCloud& cloud, const Scene& scene,
                     const std::function<cv::Mat3b(std::size_t image)>& load_color);

}  // namespace axial::cloud
