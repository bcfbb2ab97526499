// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: polygons as shapes of GDAL, and back.
#pragma once

#include <span>
#include <vector>

#include "geometry/polygon_pieces.h"
#include "private/ogr_handles.h"

namespace axial::map {

// A multipolygon of parts, each with its outer ring and its holes.
Geometry shape_of_parts(std::span<const std::vector<geometry::Ring>> parts);

// Adds the parts of a polygon, or of all polygons of a collection. Corners that are repeated are
// left out. Other shapes have no parts.
void add_parts(OGRGeometryH shape, std::vector<std::vector<geometry::Ring>>& parts);

}  // namespace axial::map
