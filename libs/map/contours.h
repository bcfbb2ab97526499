// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace axial::map {

// An empty path: the file is not written.
struct ContourFiles {
  std::filesystem::path geojson;
  std::filesystem::path package = {};  // GeoPackage
  std::filesystem::path drawing = {};  // DXF; needs `package`
};

// Writes the contour lines of a map of heights that GeoTiff wrote, in the coordinate reference
// system of the map. The lines lie at the multiples of `interval` [m, above 0]. Each is a
// line with the property "height" [m]. Its points have this height in GeoPackage and DXF. The
// coordinates of GeoJSON have four digits behind the point. All lines of the DXF are on its layer
// "contours"; a DXF states no reference system. GDAL
// computes the lines between the centres of the pixels; they end at pixels without surface. The
// files are written in place. Error that names the file that cannot be read or written.
void write_contours(const std::filesystem::path& heights, double interval,
                    const ContourFiles& files);

}  // namespace axial::map
