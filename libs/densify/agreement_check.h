// SPDX-License-Identifier: GPL-3.0-or-later
// Checks by the depth maps whether port, lens, poses and photographs belong together.
#pragma once

#include <cstddef>
#include <functional>

#include "densify/memory_plan.h"
#include "densify/project.h"
#include "scene/depth_map.h"

namespace axial::densify {

// The number of maps in one image's comparison: its own map and maps of source views.
inline constexpr std::size_t kMapsCompared = 4;

// Compares the depth maps of up to 16 images, evenly spread over the scene, with the sparse points
// and with the maps of up to three source views each. Logs a line with the numbers, as a warning if
// they disagree (AgreementLimits), and writes Settings::report. `read_map` reads the map of a
// reference image; it is called for several images at a time, as the plan allows. `photometric`:
// the maps' confidences are scores of matching alone, and a warning tells if they are too low. The
// result affects nothing else.
void check_agreement(const Project& project, const Settings& settings, const MemoryPlan& plan,
                     bool photometric, const std::function<DepthMap(std::size_t image)>& read_map);

}  // namespace axial::densify
