// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps of all images, stage by stage, each map a file: a killed run goes on where it stopped.
#pragma once

#include "existing_maps.h"
#include "image_store.h"
#include "memory_plan.h"
#include "project.h"

namespace densify {

// From this -v on pictures of the depth maps lie beside them, as in OpenMVS.
inline constexpr int kVerbosityOfPictures = 3;

// depthNNNN.dmap in the working folder, NNNN the image's global id.
std::filesystem::path depth_map_path(const Project& project, const Options& options,
                                     std::size_t image);

// Makes the final depth map of every reference image, in order:
//   photometric matching, geometric passes, speckle and gap filters (after the last pass) and the
//   adjust filter, as --postprocess-dmaps asks for them.
// Every stage reads only complete files of the stage before, so that an interrupted run gives the
// same bytes; a file counts only if its side file carries this run's fingerprint and stage.
// The first stage's maps, or a resumed run's latest, are checked for agreement (agreement_check.h).
// Several images at a time, as the plan allows. `existing`: the final maps before the run; others
// than those of this run are overwritten (see check_overwriting).
void make_depth_maps(const Project& project, const Options& options, const MemoryPlan& plan,
                     const ExistingMaps& existing, ImageStore& images);

}  // namespace densify
