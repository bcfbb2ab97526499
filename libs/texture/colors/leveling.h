// SPDX-License-Identifier: GPL-3.0-or-later
// Corrects the colours of painted charts, so that seams do not show.
#pragma once

#include <span>

#include "axial/base.h"
#include "texture/colors/global_leveling.h"

namespace axial::texture {

// The corrections at the seams of all charts.
struct Corrections {
  SeamColors colors;                    // without corrections
  std::vector<Eigen::Vector3f> global;  // the result of level_globally(), or zeros; one per node
};

// Finds the corrections for complete `colors` (add_seam_colors() in seam_colors.h). `seams`: the
// result of find_seams(). Error if `budget`, besides `colors`, does not suffice.
Corrections find_corrections(const Mesh& mesh, const Charts& charts, std::span<const Seam> seams,
                             SeamColors colors, const LevelingOptions& options,
                             const MemoryBudget& budget = {});

// Adds the global and the local corrections to the textures of the tile in work, as far as
// `options` switches them on. The textures are painted (paint() in atlas.h) and not yet levelled.
// The global correction is linear inside each face (global_leveling.h).
//
// The local correction of a chart is the solution of Laplace's equation in a strip along the seams,
// with these boundary conditions:
//   - At the seam, the solution is half of the difference between the two sides that the global
//     correction leaves, so that both sides get the mean of their colours.
//   - At the inner side of the strip, the solution is zero.
//   - There is no flow through the other borders of the chart.
// The corrected colours are then the solution of Poisson's equation with the gradients of the
// photograph (Perez, Gangnet and Blake, 2003).
//
// Pixels outside a chart's faces, up to two pixels from them, get the correction of their
// neighbours, because bilinear interpolation uses these pixels.
//
// As many charts are in work at the same time as there are threads and as `budget`, besides the
// arguments, allows, at least one. Error if `budget` does not suffice for one.
void level_charts(Atlas& atlas, const Charts& charts, std::span<const Seam> seams,
                  const Corrections& corrections, const LevelingOptions& options,
                  const MemoryBudget& budget = {});

}  // namespace axial::texture
