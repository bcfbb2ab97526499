// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: which of a folder's files hold its COLMAP model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/colmap.h"

namespace axial::io {

enum class ModelForm { text, binary };

// The file of one part, "cameras", "images" or "points3D", in `form`.
std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& part,
                                ModelForm form);

// Whether the folder holds all three parts in `form`.
bool holds_model(const std::filesystem::path& folder, ModelForm form);

// As COLMAP decides, for the folder and not for each file: binary if it holds a whole binary model,
// else text if it holds a whole text model. Error that names what is missing of both.
ModelForm model_form(const std::filesystem::path& folder);

// The form of the cameras alone: the model's, or else that of the cameras file that there is, the
// binary one of two. Error if there is none.
ModelForm cameras_form(const std::filesystem::path& folder);

// One warning that names the files of both forms, if the folder also has parts in the other form
// than `read` that differ from the model in content or cannot be read. Order, and differences of
// 1e-9 (relative beyond 1), do not count.
void warn_of_rivals(const std::filesystem::path& folder, ModelForm read, const ColmapModel& model);
void warn_of_rival_cameras(const std::filesystem::path& folder, ModelForm read,
                           const std::vector<ColmapCamera>& cameras);

}  // namespace axial::io
