// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "project.h"
#include "scene/point_cloud.h"

namespace densify {

// The final depth maps as one cloud, cropped, with colours and normals as the options say.
axial::PointCloud make_cloud(const Project& project, const Options& options);

}  // namespace densify
