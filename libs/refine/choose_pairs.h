// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the pairs of views that are compared, by the vertices that both views of a pair see.
#pragma once

#include <utility>
#include <vector>

#include "refine/scaled_views.h"

namespace axial::refine {

// Every view chooses up to `max_views` partners, by the functions of scene/view_selection.h, with a
// sample of the vertices in place of the sparse points. First, filter_neighbours() removes
// candidates whose area is below a tenth of the image, and candidates whose angle is not between
// 2.5 and 45 degrees. It stops when only max(4, 3/4 max_views) candidates remain, so that
// unsuitable candidates can stay. Then choose_source_views() takes the candidates with the highest
// scores. `visibility`: which views see which vertices of `mesh` (find_visibility()). Returns pairs
// of indices of views, each pair once. The smaller index is the first of a pair, and the pairs are
// sorted.
std::vector<std::pair<std::size_t, std::size_t>> choose_pairs(const Mesh& mesh,
                                                              const ScaledViews& views,
                                                              const Visibility& visibility,
                                                              unsigned max_views);

}  // namespace axial::refine
