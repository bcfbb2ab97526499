// SPDX-License-Identifier: GPL-3.0-or-later
// The union of polygons (GEOS).
#pragma once

#include <span>
#include <vector>

#include "geometry/polygon_pieces.h"

namespace axial::map {

// A polygon as parts beside each other: of each the outer ring and the holes. Rings may touch
// themselves and each other.
using PolygonParts = std::vector<std::vector<geometry::Ring>>;

// The area that both polygons have, as a share of the smaller one; 0 if a polygon has no area.
// Error if GEOS cannot compute it.
double common_share(const PolygonParts& a, const PolygonParts& b);

// The places that lie in at least one polygon. Polygons that are the same give their corners
// in another order. Error if GEOS cannot compute the union.
PolygonParts united(std::span<const PolygonParts* const> polygons);

}  // namespace axial::map
