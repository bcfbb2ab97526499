// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Fills cloud.normals (unit length, world frame) by principal component analysis of the
// `neighbours` nearest points of each point, including the point itself; at least 3 are used. The
// normals face the camera of the point's first view, or the mean centre of all calibrated cameras
// if the point has no views. In a cloud of fewer than 3 points the normal is the direction to this
// camera. Throws an Error for views of images that do not exist.
void estimate_normals(PointCloud& cloud, const Scene& scene, std::size_t neighbours = 16);

}  // namespace axial::cloud
