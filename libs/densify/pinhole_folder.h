// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of the pinhole export: checks, names of files, and removal of an earlier export.
#pragma once

#include <filesystem>

#include "densify/project.h"

namespace axial::densify {

// The file that marks a folder as an export and lists its other files.
inline constexpr const char* kPinholeMarker = "pinhole_export.json";

// The path of an exported image below images/: the image's path relative to `photographs`. If this
// path does not have the extension .jpg, .jpeg (in upper or lower case) or .png, ".png" is appended
// to it: a.tif becomes a.tif.png. `photographs`: the deepest common folder of all photographs
// (io::common_image_folder()).
std::filesystem::path exported_name(const SceneImage& image,
                                    const std::filesystem::path& photographs);

// The folder of the COLMAP model and its images in the folder of the export.
inline constexpr const char* kPinholeModel = "colmap";

// Removes the files of an earlier export, which are listed in its kPinholeMarker, from `folder`.
// `staging`: the folder with the new export, whose files will be moved into `folder` later. A file
// stays in two cases: `staging` contains a file with the same relative path, or the file was
// changed after the earlier export. Warns of changed files that stay, and of all files that stay
// below kPinholeModel. Warns, and removes nothing, if the earlier export has no list of its files.
// Does nothing if `folder` contains no export.
void remove_earlier_export(const std::filesystem::path& folder,
                           const std::filesystem::path& staging, const Context& context);

// Checks, before the work, whether the export can be written to `folder`. Throws an Error
// - if no camera has a port or a distorted lens,
// - if the folder contains inputs of this run (the scene file, photographs, files of their colours
//   or the working folder), or is not empty and not an earlier export,
// - if the folder is a file or cannot be written,
// - if two images would be exported to the same file.
void check_pinhole_export(const Project& project, const std::filesystem::path& folder);

}  // namespace axial::densify
