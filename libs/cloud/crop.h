// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cloud/tiles.h"
#include "scene/point_cloud.h"

namespace axial::cloud {

// Removes the points outside `region`, which is in the frame of the cloud. Points on the surface of
// the region stay. The other points keep their order and attributes. Returns the number of removed
// points.
std::size_t crop(PointCloud& cloud, const OrientedBox& region);

// Removes the points outside `tile`, as above.
std::size_t crop(PointCloud& cloud, const Tile& tile);

}  // namespace axial::cloud
