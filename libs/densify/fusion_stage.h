// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "densify/existing_maps.h"
#include "densify/image_store.h"
#include "densify/memory_plan.h"
#include "densify/project.h"
#include "io/ply/ply.h"

namespace axial::densify {

// The frame and precision of this run's clouds: the scene's frame as float, or world coordinates
// with double_precision.
io::PlyPlacement placement_of(const Project& project, const Settings& settings);

// Fuses the final depth maps to one cloud and writes it to `ply`, cropped to the region of
// interest, with colours and normals as the settings ask. Returns its number of points. The cloud
// is written as it grows, unless its colours or normals are estimated from the whole cloud (setting
// value 1). A log line, and "fusion" in the report, tell how many points rest on only two depth
// maps.
std::size_t write_cloud(const Project& project, const Settings& settings, const MemoryPlan& plan,
                        const ExistingMaps& existing, ImageStore& images,
                        const std::filesystem::path& ply);

}  // namespace axial::densify
