// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: determines which files in a folder hold its COLMAP model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/colmap/colmap.h"
#include "private/only_for_io.h"

namespace axial::io {

enum class ModelForm { text, binary };

// Returns the path of the file that holds one part of a model in `form`. `part` is "cameras",
// "images" or "points3D".
std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& part,
                                ModelForm form);

// True if the part's file exists in `form` and is a regular file.
bool has_part(const std::filesystem::path& folder, const std::string& part, ModelForm form);

// True if the folder holds all three parts in `form`.
bool holds_model(const std::filesystem::path& folder, ModelForm form);

// Returns the form in which a model is read, as COLMAP chooses it: binary if the binary model is
// complete, otherwise text if the text model is complete. All files of a model are read in one
// form. Error that names the missing files of both forms if no model is complete.
ModelForm model_form(const std::filesystem::path& folder);

// Returns the form in which the cameras are read. If a model is complete, this is
// model_form(folder). Otherwise it is the form of the cameras file that exists, or binary if
// cameras files exist in both forms. Error if there is no cameras file.
ModelForm cameras_form(const std::filesystem::path& folder);

// Warn, in one line, of files that were ignored although their contents differ from `model` or
// `cameras`. `read` is the form that was read. The ignored files are the files in the other form. A
// file that cannot be read counts as different. The order of cameras, images and points does not
// matter. Numbers a and b count as equal if |a - b| <= 1e-9 max(1, |a|, |b|).
void warn_of_ignored_files(const std::filesystem::path& folder, ModelForm read,
                           const ColmapModel& model);
void warn_of_ignored_cameras(const std::filesystem::path& folder, ModelForm read,
                             const std::vector<ColmapCamera>& cameras);

}  // namespace axial::io
