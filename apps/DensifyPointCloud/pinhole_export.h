// SPDX-License-Identifier: GPL-3.0-or-later
// --pinhole-export: the finished reconstruction as OpenMVS's later programs can take it, with
// every photograph and depth map resampled into a pinhole.
#pragma once

#include "existing_maps.h"
#include "memory_plan.h"
#include "project.h"

namespace densify {

// What an image takes in memory while it is resampled [bytes], at most.
std::uint64_t bytes_to_resample(const View& view);

// Writes the folder, whole or not at all, in place of an earlier export:
//   images/NAME, images/NAME.mask.png   for every image with a depth map; labels of PinholeImage
//   depthNNNN.dmap                      as the pinhole's
//   scene.mvs                           images under their indices, those without a map
//   uncalibrated scene.ply                           the cloud `ply`, as float in the scene's frame
//   pinhole_export.json                 what was resampled, and which files of the folder are ours
// Takes the sparse points out of the project's scene. Nothing without the option.
void export_pinholes(Project& project, const Options& options, const MemoryPlan& plan,
                     const ExistingMaps& existing, const std::filesystem::path& ply);

}  // namespace densify
