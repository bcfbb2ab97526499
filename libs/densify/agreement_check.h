// SPDX-License-Identifier: GPL-3.0-or-later
// Uses the depth maps to check whether ports, lenses, poses and photographs belong together.
#pragma once

#include <cstddef>
#include <functional>

#include "densify/memory_plan.h"
#include "densify/project.h"
#include "scene/depth_map.h"

namespace axial::densify {

// Checks whether the depth maps agree with the sparse points and with each other. Takes up to 16
// reference images, evenly spread over Project::references. Compares the map of each of these
// images with the image's sparse points, and with the maps of the first three source views that
// have maps. `context` gets a line with the numbers. The line is a warning if the maps disagree
// (AgreementLimits in depth/agreement.h). Writes the numbers to the file `report`, which is
// replaced, unless the path is empty. Changes nothing else.
// `read_map`: returns the map of a reference image; up to plan.in_flight threads call it at the
// same time. `photometric`: whether the maps are results of the photometric stage. If they are,
// their confidences are scores of matching alone, and a low median of the scores at the sparse
// points gives a warning, too.
void check_agreement(const Project& project, const MemoryPlan& plan, bool photometric,
                     const std::function<DepthMap(std::size_t image)>& read_map,
                     const std::filesystem::path& report, const Context& context);

}  // namespace axial::densify
