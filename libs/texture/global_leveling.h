// SPDX-License-Identifier: GPL-3.0-or-later
// Global seam levelling (Lempitsky and Ivanov, 2007): smooth corrections of the charts' colours
// that make both sides of each seam equal as far as possible.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "texture/charts.h"
#include "texture/seam_colors.h"

namespace axial::texture {

struct GlobalLevelingOptions {
  // Weight of the squared difference between the corrections of two neighbouring nodes of a chart,
  // where the squared difference at the end of a seam has weight 1.
  double smoothness = 0.01;
  // Weight of the squared correction itself. It keeps the corrections from drifting along chains of
  // charts.
  double smallness = 1e-4;
};

// Returns for each node the colour to add [grey levels, B G R]: the least-squares solution, by
// conjugate gradients. At each end of a seam, the colours of the two sides are means along the
// seam, whose weights fall linearly to zero at the other end.
std::vector<Eigen::Vector3f> level_globally(const Mesh& mesh, const Charts& charts,
                                            std::span<const Seam> seams, const SeamColors& colors,
                                            const GlobalLevelingOptions& options = {});

}  // namespace axial::texture
