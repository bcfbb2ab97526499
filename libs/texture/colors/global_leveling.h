// SPDX-License-Identifier: GPL-3.0-or-later
// Global seam levelling (Lempitsky and Ivanov, 2007): smooth corrections of the charts' colours
// that make both sides of each seam equal as far as possible.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/texture.h"
#include "texture/atlas/charts.h"
#include "texture/colors/seam_colors.h"

namespace axial::texture {

// Returns for each node the correction g, a colour to add [grey levels, B G R]. The corrections are
// the least-squares solution, by conjugate gradients, of
//
//       sum over the two ends of all seams of (g_a - g_b - d)^2
//     + smoothness * sum over the edges inside charts of (g_i - g_j)^2
//     + smallness * sum over the nodes of g^2.
//
// a, b: the nodes of one end of a seam, in chart a and in chart b (Seam). d: the colour of chart b
// minus the colour of chart a at this end, computed as the weighted mean of the samples along the
// seam (SeamColors). The weight of a sample falls linearly from this end of the seam to zero at the
// other end. i, j: the nodes of an edge.
std::vector<Eigen::Vector3f> level_globally(const Mesh& mesh, const Charts& charts,
                                            std::span<const Seam> seams, const SeamColors& colors,
                                            const GlobalLevelingOptions& options = {});

// The memory [bytes] of level_globally() with its result, besides its arguments.
std::uint64_t bytes_to_level_globally(std::uint64_t faces, std::uint64_t seams,
                                      std::uint64_t nodes);

}  // namespace axial::texture
