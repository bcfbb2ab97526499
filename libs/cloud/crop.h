// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/point_cloud.h"

namespace axial::cloud {

// Removes the points outside `region`; the others keep their order and attributes. Returns how many
// were removed.
std::size_t crop(PointCloud& cloud, const OrientedBox& region);

}  // namespace axial::cloud
