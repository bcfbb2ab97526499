// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: finds the files of a folder that hold its COLMAP model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/colmap/colmap.h"
#include "private/only_for_io.h"

namespace axial::io {

enum class ModelForm { text, binary };

// The file of one part ("cameras", "images" or "points3D") in `form`.
std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& part,
                                ModelForm form);

// True if the part's file exists in `form` and is a regular file.
bool has_part(const std::filesystem::path& folder, const std::string& part, ModelForm form);

// True if the folder holds all three parts in `form`.
bool holds_model(const std::filesystem::path& folder, ModelForm form);

// Chooses the form as COLMAP does, for the whole folder and not for each file: binary if the binary
// model is complete, otherwise text if the text model is complete. Error that names the missing
// files of both forms.
ModelForm model_form(const std::filesystem::path& folder);

// The form in which the cameras are read: the form of the model if it is complete, otherwise the
// form of the cameras file that exists (binary if both exist). Error if there is no cameras file.
ModelForm cameras_form(const std::filesystem::path& folder);

// Warns, in one line, of files in the other form than `read` whose content differs from the model,
// or which cannot be read. The order of the elements does not matter, nor do differences up to 1e-9
// (relative for values above 1).
void warn_of_ignored_files(const std::filesystem::path& folder, ModelForm read,
                           const ColmapModel& model);
void warn_of_ignored_cameras(const std::filesystem::path& folder, ModelForm read,
                             const std::vector<ColmapCamera>& cameras);

}  // namespace axial::io
