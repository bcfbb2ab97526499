// SPDX-License-Identifier: GPL-3.0-or-later
// The finished reconstruction in a form for OpenMVS's later programs, with every photograph and
// depth map resampled to a pinhole camera.
#pragma once

#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"

namespace axial::densify {

// An upper bound of the memory for resampling an image [bytes].
std::uint64_t bytes_needed_to_resample(const View& view);

// Writes the export folder atomically, in place of an earlier export:
//   images/NAME, images/NAME.mask.png   for every image with a depth map; labels of PinholeImage
//   depthNNNN.dmap                      depth maps of the pinhole cameras
//   scene.mvs                           images with their indices; without a map: uncalibrated
//   scene.ply                           the cloud `ply`, as float in the scene's frame
//   pinhole_export.json                 facts about the resampling, and the list of written files
// Moves the sparse points out of the project's scene. Does nothing without
// Settings::pinhole_export.
void export_pinholes(Project& project, const Settings& settings, const MemoryPlan& plan,
                     const ExistingMaps& existing, const std::filesystem::path& ply);

}  // namespace axial::densify
