// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::cloud {

// Fills cloud.normals (unit length, world frame). The normal of a point comes from a principal
// component analysis of its `neighbours` nearest points, which include the point itself. A value of
// `neighbours` below 3 is raised to 3, and a value above the number of points is reduced to it. If
// the point has views, its normal faces the camera of the first view. Otherwise it faces the mean
// centre of all calibrated cameras (the origin if there is none). In a cloud of fewer than 3 points
// the normal is the direction from the point to the camera or mean centre that it would face.
// Throws an Error for views of images that do not exist.
void estimate_normals(PointCloud& cloud, const Scene& scene, std::size_t neighbours = 16);

}  // namespace axial::cloud
