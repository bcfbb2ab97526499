// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that a run can write its files, and that none of them is one of its inputs.
#pragma once

#include <filesystem>
#include <vector>

#include "base/same_file.h"
#include "densify/project.h"

namespace axial::densify {

// The files of a run. A path may be empty, and a file need not exist.
struct RunFiles {
  std::filesystem::path scene;  // OutputOptions::scene
  // The files that belong to the input scene (files_of_scene() in io/openmvs/scene_files.h),
  // ViewOptions::point_cloud, ViewOptions::neighbour_lists and OutputOptions::other_inputs.
  std::vector<std::filesystem::path> inputs;
  // The output scene, its cloud, its lenses, and the tiles that the run may write or use.
  std::vector<std::filesystem::path> outputs;
  std::vector<NamedOutput> others;  // the report, the plan, the lists of neighbours
};

RunFiles files_of(const Options& options);

// Checks the outputs before the input scene `from` is read. Throws an Error
// - if the output scene, its cloud, one of RunFiles::others or a depth map in the working folder
//   cannot be written,
// - if one of RunFiles::outputs or RunFiles::others is one of RunFiles::inputs. The message names
//   the setting and both files.
// Also removes unfinished depth maps of stopped runs from the working folder.
void check_outputs(const RunFiles& files, const io::SceneFiles& from);

// Checks the outputs after the input scene is read. The inputs are the photographs, the masks and
// RunFiles::inputs; maps of earlier runs are not inputs. Throws an Error in two cases:
// - One of RunFiles::outputs, a depth map or a picture of a depth map would replace an input.
// - One of RunFiles::others would replace an input or another output: a depth map, a picture, or
//   the output scene with its cloud, housing, lenses or offset.
void check_outputs(const Project& project, const RunFiles& files, Pictures pictures);

}  // namespace axial::densify
