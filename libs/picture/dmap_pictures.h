// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of depth maps, as PNG files.
#pragma once

#include <filesystem>

#include "scene/depth_map.h"

namespace axial::picture {

// Writes pictures beside "<name>.dmap". <name>.png shows the depth from near (blue) to far
// (yellow). <name>.normal.png shows the normal: red to the right, green down, blue towards the
// camera. <name>.confidence.png, written if the map has confidences, shows low (dark) to high
// values. Pixels without a value are black. The lowest hundredth of the values has one colour, and
// so has the highest hundredth.
void write_dmap_pictures(const std::filesystem::path& dmap, const DepthMap& map);

}  // namespace axial::picture
