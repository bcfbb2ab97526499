// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): where two maps are enough for a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

// The neighbour that shows the point of asking pixel `i`, if no other neighbour can see the point.
// `answers[n][i]`: what neighbour n says to the pixel.
std::optional<std::size_t> only_witness(std::span<const std::vector<Answer>> answers,
                                        std::size_t i);

// Whether the map shows a piece of surface around a pixel with a depth: of the eight pixels two
// away, five or more differ from the pixel's depth by less than `max_difference` (relative), and at
// most one with a depth differs by more. Wrong depths that two views agree on by chance mostly have
// other depths around them. Five are enough, because a pixel at the image's border has no more.
bool in_surface(const FusionMap& map, std::uint32_t pixel, float max_difference);

}  // namespace axial::cloud
