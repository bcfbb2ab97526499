// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that a run can write its files, and that none of them is one of its inputs.
#pragma once

#include "densify/project.h"

namespace axial::densify {

// The files of the input scene: the scene, its housing, lenses and offset, the cloud and the lists
// of neighbours that replace its own, and Settings::other_inputs.
std::vector<std::filesystem::path> scene_files(const Settings& settings);

// Called before the scene is read. Also removes unfinished files of runs that were stopped. Error
// that names a file that cannot be written, or the setting and both files where an output is one of
// scene_files().
void check_outputs(const Settings& settings);

// The same for the photographs and masks of the scene, and for the depth maps and their pictures.
// Maps of earlier runs are not inputs. But the report and the lists of neighbours must not name a
// map or another output.
void check_outputs(const Project& project, const Settings& settings);

}  // namespace axial::densify
