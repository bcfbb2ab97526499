// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses for each face the view that gives it its colours.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "texture/adjacency.h"
#include "texture/face_views.h"

namespace axial::texture {

inline constexpr std::uint32_t kNoView = std::numeric_limits<std::uint32_t>::max();

struct LabelOptions {
  // How much a face's quality counts against a seam at one of its edges. Near 0: as few seams as
  // possible; 1: the best view for each face.
  double cost_smoothness_ratio = 0.1;
  int max_cycles = 3;  // expansions of each view, at most
};

// Minimises the sum over the faces of 2 * ratio * (1 - q / best), plus 1 for each pair of faces of
// different views, where q is the quality of the chosen view and `best` that of the best view of
// the face. The method is alpha expansion (Boykov, Veksler and Zabih, 2001) with integer costs and
// minimum cuts by Boykov and Kolmogorov's library. A face that no view sees gets kNoView and no
// seams.
std::vector<std::uint32_t> choose_views(const FaceViews& views, std::span<const FacePair> pairs,
                                        const LabelOptions& options);

}  // namespace axial::texture
