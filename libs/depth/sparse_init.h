// SPDX-License-Identifier: GPL-3.0-or-later
// Initial hypotheses from the sparse points.
#pragma once

#include <Eigen/Core>
#include <span>

#include "depth/plane_map.h"
#include "scene/camera_model.h"

namespace axial::depth {

// Makes a Delaunay triangulation of the points' images. A pixel inside a triangle gets the plane of
// the triangle's three points. The depth of the pixel is the distance at which its ray meets the
// plane (the paper's eq. 8). The normal faces the camera. A pixel has no hypothesis if it is
// outside the triangulation, if its depth is outside [min_depth, max_depth] [m], or if its ray is
// within about 3 degrees of the plane. Costs and best views of all pixels are unknown (defaults of
// PlanePixel). `camera`: at the resolution of the result. `points`: in the camera's frame [m].
// Points that do not project into the image are ignored. If fewer than 3 points remain, no pixel
// has a hypothesis.
PlaneMap planes_from_points(const CameraModel& camera, std::span<const Eigen::Vector3f> points,
                            float min_depth, float max_depth);

}  // namespace axial::depth
