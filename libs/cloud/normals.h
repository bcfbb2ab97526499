// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Normals by principal components of the `neighbours` nearest points (the point included), facing
// the camera of the point's first view; towards the mean of all cameras for a cloud without views.
// Clouds of fewer than 3 points get the direction to the camera.
void estimate_normals(PointCloud& cloud, const Scene& scene, std::size_t neighbours = 16);

}  // namespace axial::cloud
