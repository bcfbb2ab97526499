// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of depth maps, as PNG files.
#pragma once

#include <filesystem>

#include "scene/depth_map.h"

namespace axial::picture {

// Writes pictures of `map` beside `dmap`, the path "<name>.dmap" of its file, and replaces existing
// files. The file `dmap` is not read. <name>.png shows the depth from near (blue) to far (yellow).
// <name>.normal.png shows the normal: red to the right, green down, blue towards the camera.
// <name>.confidence.png, written if the map has confidences, shows low (dark) to high values.
// Pixels without a value are black. In the pictures of depths and confidences, colours are linear
// in the value, except that the lowest hundredth of the values has one colour, and the highest
// hundredth another. Error that names the file if a picture cannot be written.
void write_dmap_pictures(const std::filesystem::path& dmap, const DepthMap& map);

}  // namespace axial::picture
