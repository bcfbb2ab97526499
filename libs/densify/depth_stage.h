// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the depth maps of all images, stage by stage. Each map is a file, so that a run that was
// stopped continues where it ended.
#pragma once

#include "densify/existing_maps.h"
#include "densify/image_store.h"
#include "densify/memory_plan.h"
#include "densify/project.h"

namespace axial::densify {

// depthNNNN.dmap in the working folder, where NNNN is the image's global id.
std::filesystem::path depth_map_path(const Project& project, const Settings& settings,
                                     std::size_t image);

// Makes the final depth map of every reference image. Stages in this order: photometric matching,
// geometric passes, speckle and gap filters (after the last pass), and the adjust filter; the
// filters as Settings::postprocess asks for them.
//
// Every stage reads only complete files of the previous stage, so that a resumed run gives the same
// bytes. A file is reused only if its side file has the fingerprint of this run and the stage's
// name. The maps of the first stage, or the latest maps of a resumed run, are checked for agreement
// (agreement_check.h). Several images are worked on at a time, as the plan allows. `existing`: the
// final maps before the run; maps that are not of this run are overwritten (see check_overwriting).
void make_depth_maps(const Project& project, const Settings& settings, const MemoryPlan& plan,
                     const ExistingMaps& existing, ImageStore& images);

}  // namespace axial::densify
