// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace axial {

// The pose of a camera in the world: x_in_camera = rotation * (x_in_world - centre). Camera axes: x
// right, y down, z forward. Both frames have one unit: metres if a camera is behind the port of a
// housing.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // from the world to the camera
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        // camera centre in the world

  // Convert a point between the frames of the world and of the camera.
  Eigen::Vector3d to_camera(const Eigen::Vector3d& x_in_world) const {
    return rotation * (x_in_world - centre);
  }
  Eigen::Vector3d to_world(const Eigen::Vector3d& x_in_camera) const {
    return rotation.transpose() * x_in_camera + centre;
  }
};

}  // namespace axial
