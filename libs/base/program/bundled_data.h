// SPDX-License-Identifier: GPL-3.0-or-later
// The data of GDAL and PROJ in an archive of the programs with all their libraries
// (packaging/archive.py).
#pragma once

#include <filesystem>

namespace axial {

// Gives GDAL and PROJ the folders share/axialmvs/gdal and share/axialmvs/proj of `prefix`, by the
// environment variables of this process. These libraries otherwise look into folders of the system,
// which may be absent or of another version. PROJ then still finds grids in the folders of the
// user's PROJ_DATA, or of PROJ_LIB. GDAL loads no plugins, because those of the system are for the
// system's GDAL. Does nothing if `prefix` has no such folders. Call it before other threads start.
void use_bundled_data(const std::filesystem::path& prefix);

}  // namespace axial
