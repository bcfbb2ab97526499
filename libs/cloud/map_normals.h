// SPDX-License-Identifier: GPL-3.0-or-later
// Normals of a depth map from its depths.
#pragma once

#include <opencv2/core.hpp>

#include "scene/depth_map.h"

namespace axial::cloud {

// Returns the normals of a map, estimated from the back-projected points in the 3x3 neighbourhood
// of each pixel. A neighbour counts if its depth differs from that of the pixel by less than 3 %.
// At least 3 neighbours must count. The normals have unit length, are in the camera frame and face
// the camera. The normal is 0 where there is no depth or where the estimation fails. `map.normal`
// is not used.
cv::Mat3f estimate_map_normals(const DepthMap& map);

}  // namespace axial::cloud
