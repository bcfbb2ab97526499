// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps to look at.
#pragma once

#include <filesystem>

#include "scene/depth_map.h"

namespace axial::io {

// Beside "<name>.dmap": <name>.png, depth from near (blue) to far (yellow); <name>.normal.png, red
// to the right, green down, blue towards the camera; <name>.confidence.png, from low (dark) to
// high. Black where there is nothing. The hundredth of the values at either end share a colour.
void write_dmap_pictures(const std::filesystem::path& dmap, const DepthMap& map);

}  // namespace axial::io
