// SPDX-License-Identifier: GPL-3.0-or-later
// What changed between two surveys in a polygon of the map.
#pragma once

#include "axial/compare.h"
#include "map/area_measures.h"

namespace axial::compare {

// Lengths are in metres. Without a compared place, all numbers but the areas and volumes are NaN.
struct AreaChange {
  double compared = 0;  // area of the polygon in which the surveys are compared [m^2]
  Volume came, gone;    // of the regions of significant change, as Changes
  // Later minus earlier, of all compared places: volume [m^3] and mean height.
  double net = map::kNotKnown, net_sigma = map::kNotKnown;
  double mean = map::kNotKnown, mean_sigma = map::kNotKnown;
  // The difference of height with the largest amount.
  double largest = map::kNotKnown, largest_sigma = map::kNotKnown;
};

// The change at the pixels whose centres are in the polygon. Regions of change end at the polygon.
// Standard deviations are those of find_changes(); the uncertainty of a registration is not in
// them but for `came` and `gone`. Errors as for geometry::PolygonPieces.
AreaChange change_in(const Comparison& comparison, const map::Area& area);

}  // namespace axial::compare
