// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the files that the paths of images and masks in a scene name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "axial/base.h"
#include "bytes/private/only_for_io.h"

namespace axial::io {

// The folders above the scene's folder in which files are searched for.
inline constexpr int kFoldersAboveScene = 3;

// Returns the absolute path of each file that `names` names; an empty path for an empty name. All
// relative names start at one folder. Candidates are the working folder, as in OpenMVS, then the
// folder of the scene, then the kFoldersAboveScene folders above it, from the nearest: the scene
// was written in this working folder, or was moved together with its photographs. The folder is the
// first candidate that has all files, otherwise the first that has the most, and the working folder
// if no candidate has any. An absolute name below the working folder counts as a relative name if
// its file does not exist; all other absolute names are returned as they are.
//
// `working_folder`: absolute and normal. `what`: the files in plural, for messages. A line
// of `context` states a folder that is not the working folder. Warns once through `context` if the
// working folder or the folder of the scene has another file of the same name than the one that is
// returned.
std::vector<std::string> find_files_of_scene(const std::filesystem::path& working_folder,
                                             const std::filesystem::path& scene,
                                             const std::vector<std::string>& names,
                                             std::string_view what, const Context& context);

}  // namespace axial::io
