// SPDX-License-Identifier: GPL-3.0-or-later
// Corrects the colours of painted charts, so that seams do not show.
#pragma once

#include <span>

#include "texture/global_leveling.h"

namespace axial::texture {

struct LevelingOptions {
  bool global = true;  // smooth corrections of whole charts (global_leveling.h)
  bool local = true;   // corrections in a strip along the seams
  GlobalLevelingOptions global_options;
  int strip = 20;  // width of the strip [px]
};

// Adds the corrections to the textures. The local correction of a chart is the solution of
// Laplace's equation in the strip: at the seam half of the difference that global levelling leaves,
// so that both sides become their mean; zero at the strip's inner side; no flow through other
// borders of the chart. Colours are then the solution of Poisson's equation with the gradients of
// the photograph (Perez, Gangnet and Blake, 2003). Pixels up to two outside a chart's faces get the
// correction of their neighbours, because bilinear interpolation uses them.
void level_seams(Atlas& atlas, const Mesh& mesh, const Charts& charts, std::span<const Seam> seams,
                 const LevelingOptions& options);

}  // namespace axial::texture
