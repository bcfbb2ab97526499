// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "existing_maps.h"
#include "image_store.h"
#include "io/ply.h"
#include "memory_plan.h"
#include "project.h"

namespace densify {

// The frame and precision of this run's clouds: the scene's frame as float, or world coordinates
// with --output-precision double.
axial::io::PlyPlacement placement_of(const Project& project, const Options& options);

// Fuses the final depth maps to one cloud and writes it to `ply`, cropped to the region of
// interest, with colours and normals as the options ask. Returns its number of points. The cloud is
// written as it grows, unless its colours or normals are estimated from the whole cloud (option
// value 1). A log line, and "fusion" in --report-file, tell how many points rest on only two depth
// maps.
std::size_t write_cloud(const Project& project, const Options& options, const MemoryPlan& plan,
                        const ExistingMaps& existing, ImageStore& images,
                        const std::filesystem::path& ply);

}  // namespace densify
