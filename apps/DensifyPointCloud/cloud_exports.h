// SPDX-License-Identifier: GPL-3.0-or-later
// What OpenMVS's program does instead of densifying: clouds derived from the scene's own points, or
// those of -p.
#pragma once

#include <functional>

#include "options.h"
#include "project.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace densify {

// The sparse points as a cloud.
axial::PointCloud cloud_of(const axial::Scene& scene);

// Keeps the points of `scene`, with their normals and colours, that `kept` says yes to, in their
// order.
void keep_points(axial::Scene& scene, const std::function<bool(std::size_t point)>& kept);

// Whether the options ask for one of these.
bool only_exports(const Options& options);

// Writes the first that is asked for, beside the output and named after it:
//   --filter-point-cloud T < 0   <out>_filtered.ply and .mvs: points whose visibility is above T
//   --export-number-views N      <out>_<N>views.ply: points seen by |N| images or more; N < 0: .mvs
//   --estimate-scale F > 0       <out>_scale.ply: every point's size, F pixels of its mean view
// Clouds are where placement_of() says, and scenes have ports, lenses and offset beside them. A
// warning for further ones that are asked for. Error if the scene of `project`, of load_scene(),
// has no points, or where an output is a file that was read.
void export_cloud(Project project, const Options& options);

}  // namespace densify
