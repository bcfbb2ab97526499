// SPDX-License-Identifier: GPL-3.0-or-later
// Whether port, lens, poses and photographs belong together, as far as depth maps tell.
#pragma once

#include <cstddef>
#include <functional>

#include "memory_plan.h"
#include "project.h"
#include "scene/depth_map.h"

namespace densify {

// Maps that one image's comparison takes: its own and those of source views.
inline constexpr std::size_t kMapsCompared = 4;

// Compares the depth maps of up to 16 images, evenly spread over the scene, with its sparse points
// and with the maps of up to three of their source views; a line with the numbers, which is a
// warning if they disagree (AgreementLimits), and --report-file. `read_map`: the map of a reference
// image; several at a time, as the plan allows. `photometric`: their confidences are scores of
// matching alone, and a warning says where these are too low. Nothing else depends on the outcome.
void check_agreement(const Project& project, const Options& options, const MemoryPlan& plan,
                     bool photometric,
                     const std::function<axial::DepthMap(std::size_t image)>& read_map);

}  // namespace densify
