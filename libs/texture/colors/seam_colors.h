// SPDX-License-Identifier: GPL-3.0-or-later
// The difference of colours between the two sides of each seam.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "texture/atlas/atlas.h"
#include "texture/atlas/charts.h"

namespace axial::texture {

// Samples along the seams. The samples of seam s are at [begin[s], begin[s + 1]) of `differences`.
// Let p and q be the positions of the seam's first and second node (Seam) in the texture of one of
// its charts. A seam with n samples has its sample k at (1 - t) p + t q, where t = (k + 1/2) / n.
// The number n is twice the length of the seam [px of the textures], rounded up, and at least 2.
// The length is the larger of the lengths in the two charts.
struct SeamColors {
  std::vector<std::uint32_t> begin;
  // Colour in chart b minus colour in chart a (Seam) [grey levels, B G R].
  std::vector<Eigen::Vector3f> differences;

  std::span<const Eigen::Vector3f> of(std::size_t seam) const {
    return std::span(differences).subspan(begin[seam], begin[seam + 1] - begin[seam]);
  }
};

// Returns the samples of all seams with differences of zero. add_seam_colors() then adds the
// colours, tile by tile.
SeamColors seam_samples(const Atlas& atlas, std::span<const Seam> seams);

// Samples the textures of the tile in work at those sides of the seams whose chart belongs to the
// tile. Adds the colours of side b to the differences, and subtracts those of side a. The textures
// must be painted and not yet levelled. The differences are complete after one call for each tile.
// They do not depend on the tiles or on their order.
void add_seam_colors(SeamColors& colors, const Atlas& atlas, const Charts& charts,
                     std::span<const Seam> seams);

// The memory [bytes] of the result of seam_samples().
std::uint64_t bytes_of_seams(const Atlas& atlas, std::span<const Seam> seams);

}  // namespace axial::texture
