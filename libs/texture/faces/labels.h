// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses for each face the view from which the face gets its colours.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "axial/texture.h"
#include "texture/faces/adjacency.h"
#include "texture/faces/face_views.h"

namespace axial::texture {

// Stands for the view of a face that no view sees.
inline constexpr std::uint32_t kNoView = std::numeric_limits<std::uint32_t>::max();

// Returns for each face the index of its view, or kNoView for a face that no view sees. `pairs`:
// the result of face_pairs() (adjacency.h). The result minimises, approximately, the cost
//
//       sum over the faces of 2 * ratio * (1 - q / best)
//     + the number of pairs of faces with different views,
//
// where q is the quality of the face's chosen view, `best` the highest quality of the face's views,
// and ratio is cost_smoothness_ratio. Faces with kNoView do not count. The method is alpha
// expansion (Boykov, Veksler and Zabih, 2001) with costs rounded to thousandths. Minimum cuts are
// computed by Boykov and Kolmogorov's library.
std::vector<std::uint32_t> choose_views(const FaceViews& views, std::span<const FacePair> pairs,
                                        const LabelOptions& options);

// The memory [bytes] of choose_views() besides its arguments.
std::uint64_t bytes_to_choose_views(const FaceViews& views);

}  // namespace axial::texture
