// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds that OpenMVS's program writes instead of densifying. They are derived from the scene's own
// points, or from the points of -p.
#pragma once

#include <functional>

#include "options.h"
#include "project.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace densify {

// The sparse points as a cloud.
axial::PointCloud cloud_of(const axial::Scene& scene);

// Keeps the points of `scene` for which `kept` returns true, in their order, with their normals and
// colours.
void keep_points(axial::Scene& scene, const std::function<bool(std::size_t point)>& kept);

// Whether the options ask for one of these clouds.
bool only_exports(const Options& options);

// Writes the first cloud that the options ask for, beside the output and named after it:
//   --filter-point-cloud T < 0   <out>_filtered.ply and .mvs: points whose visibility is above T
//   --export-number-views N      <out>_<N>views.ply: points seen by |N| images or more; N < 0: .mvs
//   --estimate-scale F > 0       <out>_scale.ply: every point's size, F pixels of its mean view
// Clouds are in the frame of placement_of(). Ports, lenses and offset are written beside scenes.
// `project` is the result of load_scene(). Error if its scene has no points, or if an output is a
// file that was read.
void export_cloud(Project project, const Options& options);

}  // namespace densify
