// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons on a map, from files of GIS programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/polygon_pieces.h"

namespace axial::map {

// A polygon of a file, perhaps with holes and several parts.
struct Area {
  std::string name;
  // Parts beside each other: of each the outer ring and the holes [map]. At least one part. Each
  // ring has three corners or more, and no rings cross.
  std::vector<std::vector<geometry::Ring>> parts;
};

// The polygons of a GeoJSON, GeoPackage or shape file, in their order; curves become lines. The
// name of an area is the value of the field name, otherwise of label, otherwise of id (in any
// case), otherwise the number of the feature, from 1. `crs`: of the map, as WKT; empty: none.
// Coordinates in another system are converted to that of the map. A GeoJSON file without a system
// has WGS 84 (RFC 7946). Coordinates of other files without a system, and all coordinates if the
// map has none, are taken for coordinates of the map.
// Error that names the file, and the polygon: the file cannot be read; it has no layer with
// polygons, or several; a feature is no polygon; a ring has fewer than three corners; a coordinate
// is not finite or cannot be converted; rings cross, or a part lies in another part.
std::vector<Area> read_areas(const std::filesystem::path& file, const std::string& crs);

}  // namespace axial::map
