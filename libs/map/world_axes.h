// SPDX-License-Identifier: GPL-3.0-or-later
// The axes and the origin of a map in the world, as the files of the map state them.
#pragma once

#include <Eigen/Core>

#include "map/frame.h"
#include "scene/local_frame.h"

namespace axial::map {

// The axes of a map: map = axes * world + offset, with x, y and height of the map.
struct WorldAxes {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // a rotation
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();    // [map, m]

  Eigen::Vector3d to_world(const Eigen::Vector3d& on_map) const {
    return axes.transpose() * (on_map - offset);
  }
};

// True for a rotation, up to 1e-6: texts have fewer digits than numbers.
bool is_rotation(const Eigen::Matrix3d& matrix);

// The axes of a map with the frame `frame`, for a mesh with the frame `mesh_frame`.
WorldAxes world_axes(const MapFrame& frame, const LocalFrame& mesh_frame);

}  // namespace axial::map
