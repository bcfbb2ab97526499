// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/world_axes.h"

#include <Eigen/LU>

namespace axial::map {

bool is_rotation(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-6;
  return (matrix * matrix.transpose()).isIdentity(kTolerance) && matrix.determinant() > 0;
}

WorldAxes world_axes(const MapFrame& frame, const LocalFrame& mesh_frame) {
  return {frame.axes, frame.origin - frame.axes * mesh_frame.origin};
}

}  // namespace axial::map
