// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "existing_maps.h"
#include "image_store.h"
#include "io/ply.h"
#include "memory_plan.h"
#include "project.h"

namespace densify {

// Where the clouds of this run are: in the scene's frame, or by --output-precision double in the
// world.
axial::io::PlyPlacement placement_of(const Project& project, const Options& options);

// Writes the final depth maps as one cloud to `ply`, cropped, with colours and normals as the
// options say; returns its number of points. The cloud goes to the file as it grows, unless its
// colours or normals are estimated from the whole of it (1). A line, and "fusion" in --report-file,
// say how many points rest on two depth maps.
std::size_t write_cloud(const Project& project, const Options& options, const MemoryPlan& plan,
                        const ExistingMaps& existing, ImageStore& images,
                        const std::filesystem::path& ply);

}  // namespace densify
