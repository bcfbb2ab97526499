// SPDX-License-Identifier: GPL-3.0-or-later
// Exports the finished reconstruction for OpenMVS's later programs. Every photograph with a depth
// map, and its depth map, are resampled to a pinhole camera.
#pragma once

#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"

namespace axial::densify {

// An upper bound of the memory [bytes] for resampling one image and its depth map.
std::uint64_t bytes_needed_to_resample(const View& view);

// Writes the export folder atomically, in place of an earlier export. The folder contains
//   images/NAME, images/NAME.mask.png   for every image with a depth map: the resampled photograph,
//                                       and its labels (cloud::PinholeImage)
//   depthNNNN.dmap                      depth maps of the pinhole cameras
//   scene.mvs                           all images in the scene's order; images without a depth map
//                                       are uncalibrated
//   scene.ply                           the cloud `ply`, as float in the scene's frame
//   pinhole_export.json                 facts about the resampling, and the list of written files
// Moves the sparse points out of the project's scene, which has no points afterwards. Does
// nothing if Settings::pinhole_export is empty.
void export_pinholes(Project& project, const Settings& settings, const MemoryPlan& plan,
                     const ExistingMaps& existing, const std::filesystem::path& ply);

}  // namespace axial::densify
