// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::view {

// Where a viewer looks first: at the whole cloud, or without a cloud at the corners of the mesh's
// faces, as the photographs see it.
struct FirstView {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    // of the cloud: the median of its points
  double radius = 1;                                   // nine of ten points are nearer to `centre`
  Eigen::Vector3d towards = Eigen::Vector3d::UnitZ();  // mean viewing direction, unit
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();      // unit, not parallel to `towards`
};

// The view of `cloud`, which may be the corners of a mesh. `images` are the photographs: only those
// that are calibrated count. `up` is the mean upward direction of the photographs, or the z axis if
// `z_is_up`. If the mean of directions vanishes, or if `up` would be parallel to `towards`, another
// direction is chosen.
FirstView first_view(const PointCloud& cloud, std::span<const SceneImage> images, bool z_is_up);

}  // namespace axial::view
