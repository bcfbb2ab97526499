// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the depth maps of all images, stage by stage. Each map is a file, so that a run that was
// stopped continues where it ended.
#pragma once

#include "densify/run.h"

namespace axial::densify {

// Makes the final depth map of every reference image (Project::references) and writes it to
// depth_map_path(). If `job` is given, ends after its stage StageJob::until. If StageJob::parts is
// above 0, makes only the maps of this stage, and only of the images Project::part (run_part() in
// map_stages.h). The stages are, in this order: photometric matching,
// MatchOptions::geometric_iterations geometric passes, and the adjust filter if
// MatchOptions::postprocess asks for it. The last stage before the adjust filter also removes
// unconfirmed depths (depth/weak_texture.h), and then applies the speckle filter and the gap
// filter, each if MatchOptions::postprocess asks for it.
//
// Every stage reads only complete files of the previous stage, so that a resumed run gives the same
// bytes. A file is reused only if its side file (io/openmvs/dmap.h) has the fingerprint of this run
// and the stage's name. The maps of the first stage, or the latest complete maps of a resumed run,
// are checked for agreement (agreement_check.h), with the file `report`. Files that are not reused
// are overwritten, also files of other programs. So call check_overwriting() (existing_maps.h)
// before. Throws an Error for an image that cannot be read and for a file that cannot be written.
void make_depth_maps(const Run& run, const MatchOptions& options, const StageJob* job,
                     const std::filesystem::path& report);

}  // namespace axial::densify
