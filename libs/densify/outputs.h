// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that a run can write its files, and that none of them is one of its inputs.
#pragma once

#include "densify/project.h"

namespace axial::densify {

// The files that belong to the input scene (files_of_scene() in io/openmvs/scene_files.h),
// Settings::point_cloud, Settings::neighbour_lists and Settings::other_inputs. A path may be
// empty, and a file need not exist.
std::vector<std::filesystem::path> scene_files(const Settings& settings);

// Checks the outputs before the input scene is read. The output scene is Settings::output; its
// cloud and lenses are files beside it. Throws an Error
// - if the output scene, its cloud, the report (unless Settings::report is empty) or a depth map in
//   the working folder cannot be written,
// - if the output scene, its cloud, its lenses, the report or Settings::neighbour_lists_output is
//   one of scene_files(). The message names the setting and both files.
// Also removes unfinished depth maps of stopped runs from the working folder.
void check_outputs(const Settings& settings);

// Checks the outputs after the input scene is read. The inputs are the photographs, the masks and
// scene_files(); maps of earlier runs are not inputs. Throws an Error in two cases:
// - The output scene, its lenses, its cloud, a depth map or a picture of a depth map would replace
// an
//   input.
// - Settings::report or Settings::neighbour_lists_output would replace an input or another output:
//   a depth map, a picture, or the output scene with its cloud, housing, lenses or offset.
void check_outputs(const Project& project, const Settings& settings);

}  // namespace axial::densify
