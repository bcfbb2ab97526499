// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the pairs of views that are compared, from the vertices that both see.
#pragma once

#include <utility>
#include <vector>

#include "refine/scaled_views.h"

namespace axial::refine {

// Every view chooses up to `max_views` partners by the score of scene/view_selection.h, where a
// sample of the vertices takes the place of the sparse points. A partner shares at least a tenth of
// the image and has an angle between 2.5 and 45 degrees, unless there are too few such views. The
// result has the smaller index first, and is sorted.
std::vector<std::pair<std::size_t, std::size_t>> choose_pairs(const Mesh& mesh,
                                                              const ScaledViews& views,
                                                              const Visibility& visibility,
                                                              unsigned max_views);

}  // namespace axial::refine
