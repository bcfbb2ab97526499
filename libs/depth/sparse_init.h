// SPDX-License-Identifier: GPL-3.0-or-later
// First hypotheses from the sparse cloud.
#pragma once

#include <Eigen/Core>
#include <span>

#include "depth/plane_map.h"
#include "scene/camera_model.h"

namespace axial::depth {

// The Delaunay triangulation of the points' images, each pixel on its triangle's plane: depth where
// the pixel's ray meets the plane (eq. 8) if within [min_depth, max_depth], normal facing the
// camera. `points`: in the reference camera's frame [m]; those not visible are ignored. Pixels
// outside the triangulation have no hypothesis. `camera`: at the map's resolution.
PlaneMap planes_from_points(const CameraModel& camera, std::span<const Eigen::Vector3f> points,
                            float min_depth, float max_depth);

}  // namespace axial::depth
