// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of the pinhole export: checks, names of files, and removal of an earlier export.
#pragma once

#include <filesystem>

#include "densify/project.h"

namespace axial::densify {

// The file that marks a folder as an export and lists its other files.
inline constexpr const char* kPinholeMarker = "pinhole_export.json";

// The name of an exported image below images/: its path relative to `photographs`, the deepest
// common folder of all photographs. Other formats than JPEG and PNG get the extension .png.
std::filesystem::path exported_name(const SceneImage& image,
                                    const std::filesystem::path& photographs);

// Removes files of the earlier export in `folder` that `staging` does not replace and that have not
// been changed since. Warns of files that were changed, and of an earlier export that lists no
// files; these files stay.
void remove_earlier_export(const std::filesystem::path& folder,
                           const std::filesystem::path& staging);

// Called before the work. Error if all cameras are pinholes already, if the folder contains other
// files or inputs of this run, if it cannot be written, or if two images would get the same name.
// Does nothing without Settings::pinhole_export.
void check_pinhole_export(const Project& project, const Settings& settings);

}  // namespace axial::densify
