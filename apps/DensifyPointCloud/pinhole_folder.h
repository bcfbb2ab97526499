// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of --pinhole-export: whether it may be written, and what files in it are called.
#pragma once

#include <filesystem>

#include "project.h"

namespace densify {

// The file that says that a folder is an export, and lists its other files.
inline constexpr const char* kPinholeMarker = "pinhole_export.json";

// An image's name below images/: the way from `photographs`, the deepest folder of all. JPEGs and
// PNGs keep their names.
std::filesystem::path exported_name(const axial::SceneImage& image,
                                    const std::filesystem::path& photographs);

// Of the export that `folder` holds, removes the files that `staging` has no successor of and that
// are as they were written. Warnings for those that somebody changed, and for an export that lists
// no files: they stay.
void remove_earlier_export(const std::filesystem::path& folder,
                           const std::filesystem::path& staging);

// Before hours of work: Error if all cameras are pinholes already, if the folder holds files of
// others or is one that inputs lie in, if it cannot be written, or if two images would get one
// name. Nothing without the option.
void check_pinhole_export(const Project& project, const Options& options);

}  // namespace densify
