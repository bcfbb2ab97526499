// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "axial/base.h"

namespace axial::map {

// Warns that the code `epsg` names a reference system, although the coordinates of `file` are near
// the origin, as local coordinates are. The caller has found that they are. Without effect if
// `epsg` is 0: no system.
void warn_of_local_coordinates(int epsg, const std::filesystem::path& file, const Context& context);

}  // namespace axial::map
