// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"
#include "io/ply/ply.h"
#include "survey/image_store.h"

namespace axial::densify {

// The frame and precision of this run's clouds: float positions in the scene's frame, or, if
// Settings::double_precision is true, double positions in world coordinates.
io::PlyPlacement placement_of(const Project& project, const Settings& settings);

// Fuses the final depth maps of Project::references to one cloud and writes the cloud to the file
// `ply`, in the frame of placement_of(). The settings decide whether the cloud is cropped to the
// region of interest, and whether it has colours and normals. Returns the number of points of the
// cloud.
// With more than one tile (Settings::fusion_tiles), or if the file of the only tile exists, the
// maps are fused tile by tile: see write_tiles() in tile_stage.h. Otherwise they are fused in one
// piece. The cloud is written as it grows, unless its colours or normals are estimated from the
// whole cloud (Settings::estimate_colors or estimate_normals is 1). A log line tells how many
// points are supported by only two depth maps. Unless Settings::report is empty, an entry "fusion"
// in this file tells the same. The file must exist: check_agreement() writes it. `existing`: the
// result of find_existing_maps(). Calls map_large_blocks() (base/memory.h). Throws an Error if a
// map or an image cannot be read, or if a file cannot be written.
std::size_t write_cloud(const Project& project, const Settings& settings, const MemoryPlan& plan,
                        const ExistingMaps& existing, survey::ImageStore& images,
                        const std::filesystem::path& ply);

}  // namespace axial::densify
