// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a run writes: they can be written, and none of them is one that it reads.
#pragma once

#include "project.h"

namespace densify {

// The files that make the scene: the scene itself, its housing, lenses and offset, the cloud and
// the lists of neighbours that stand in for its own, and the file of settings.
std::vector<std::filesystem::path> scene_files(const Options& options);

// Before the scene is read. What killed runs left half-written goes. Error that names the file that
// cannot be written, or the option and both files where an output is one of scene_files().
void check_outputs(const Options& options);

// The same for the photographs and masks of the scene, and for depth maps and their pictures. Maps
// of earlier runs are no inputs; but --report-file and --output-view-neighbors-file name neither
// them nor another file of the reconstruction.
void check_outputs(const Project& project, const Options& options);

}  // namespace densify
