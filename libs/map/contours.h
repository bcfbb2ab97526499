// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace axial::map {

// Writes the contour lines of a map of heights that GeoTiff wrote, as GeoJSON in the coordinate
// reference system of the map. The lines lie at the multiples of `interval` [m, above 0]. Each is a
// LineString with the property "height" [m]. Coordinates have four digits behind the point. GDAL
// computes the lines between the centres of the pixels; they end at pixels without surface. The
// file is written in place. Error that names the file that cannot be read or written.
void write_contours(const std::filesystem::path& heights, double interval,
                    const std::filesystem::path& path);

}  // namespace axial::map
