// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds that OpenMVS's program writes instead of densifying. They are derived from the scene's own
// points, or from Settings::point_cloud.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "densify/project.h"
#include "densify/settings.h"
#include "scene/scene.h"

namespace axial::densify {

// Keeps the points of `scene` for which `kept` returns true, in their order, with their normals and
// colours.
void keep_points(Scene& scene, const std::function<bool(std::size_t point)>& kept);

struct WrittenCloud {
  std::filesystem::path file;  // .ply
  std::size_t points = 0;
};

// Writes the first cloud that the settings ask for, beside the output and named after it:
//   filter_point_cloud T < 0   <out>_filtered.ply and .mvs: points whose visibility is above T
//   export_number_views N      <out>_<N>views.ply: points seen by |N| images or more; N < 0: .mvs
//   estimate_scale F > 0       <out>_scale.ply: every point's size, F pixels of its mean view
// Clouds are in the frame of placement_of(). Ports, lenses and offset are written beside scenes.
// `project` is the result of load_scene(). Error if its scene has no points, or if an output is a
// file that was read.
WrittenCloud export_cloud(Project project, const Settings& settings);

}  // namespace axial::densify
