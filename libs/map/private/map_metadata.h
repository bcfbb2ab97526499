// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: the axes of a map as metadata of its file.
#pragma once

#include <gdal.h>

#include <filesystem>
#include <optional>

#include "map/world_axes.h"

namespace axial::map {

// Writes the items AXIALMVS_AXES (nine numbers, row by row) and AXIALMVS_OFFSET (three numbers):
// the members of WorldAxes.
void state_axes(GDALDatasetH file, const WorldAxes& axes);

// The axes that the file states; empty if it states none. Error that names the file `path` and the
// item if an item does not have its numbers, or if the axes are no rotation.
std::optional<WorldAxes> axes_in(GDALDatasetH file, const std::filesystem::path& path);

// The grid of a map that GeoTiff wrote.
MapGrid grid_of(GDALDatasetH file);

}  // namespace axial::map
