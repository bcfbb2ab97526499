// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the depth maps of all images, stage by stage. Each map is a file, so that a run that was
// stopped continues where it ended.
#pragma once

#include <string>
#include <vector>

#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"
#include "survey/image_store.h"

namespace axial::densify {

// The names of the stages of make_depth_maps(), in their order: "photometric", "geometric1",
// "geometric2", ..., and "adjusted" if Settings::postprocess asks for the adjust filter.
std::vector<std::string> stage_names(const Settings& settings);

// The number of stages up to the stage Settings::until: 1 for the first. "maps" means the last
// stage. All stages if `until` is empty. Throws an Error that lists the names if `until` is none of
// them.
std::size_t stages_to_make(const Settings& settings);

// The path of the file of an image's final depth map: depthNNNN.dmap in the working folder, where
// NNNN is the image's global id (View::id) with at least four digits. `image`: index into
// Project::views. The file need not exist.
std::filesystem::path depth_map_path(const Project& project, const Settings& settings,
                                     std::size_t image);

// The text `made_from` (io/openmvs/dmap.h) of the final depth maps that a run with these settings
// makes.
std::string final_made_from(const Project& project, const Settings& settings);

// Makes the final depth map of every reference image (Project::references) and writes it to
// depth_map_path(). If Settings::until is given, ends after this stage. If Settings::parts is above
// 0, makes only the maps of this stage, and only of the images Project::part (run_part() in
// map_stages.h). The stages are, in this order: photometric matching,
// Settings::geometric_iterations geometric passes, and the adjust filter if Settings::postprocess
// asks for it. The last stage before the adjust filter also removes unconfirmed depths
// (depth/weak_texture.h), and then applies the speckle filter and the gap filter, each if
// Settings::postprocess asks for it.
//
// Every stage reads only complete files of the previous stage, so that a resumed run gives the same
// bytes. A file is reused only if its side file (io/openmvs/dmap.h) has the fingerprint of this run
// and the stage's name. The maps of the first stage, or the latest complete maps of a resumed run,
// are checked for agreement (agreement_check.h). `plan` says how many images are processed at a
// time. `existing`: the states of the final map files before the run. `images`: the pixels. Files
// that are not reused are overwritten, also files of other programs. So call check_overwriting()
// (existing_maps.h) before. Throws an Error for an image that cannot be read and for a file that
// cannot be written.
void make_depth_maps(const Project& project, const Settings& settings, const MemoryPlan& plan,
                     const ExistingMaps& existing, survey::ImageStore& images);

}  // namespace axial::densify
