// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "base/context.h"
#include "scene/local_frame.h"
#include "scene/point_cloud.h"

namespace axial::apps {

// The distances [m] of the points of `cloud`, in `frame`, to the surface of the mesh in the PLY
// file `truth`. Error that names the file if it is malformed, or if the mesh has no faces.
std::vector<float> distances_to_truth(const LocalFrame& frame, const PointCloud& cloud,
                                      const std::filesystem::path& truth, const Context& context);

}  // namespace axial::apps
