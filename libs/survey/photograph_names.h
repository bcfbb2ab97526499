// SPDX-License-Identifier: GPL-3.0-or-later
// The names of photographs in texts and in folders of results.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "survey/survey.h"

namespace axial::survey {

// The paths of the photographs of all views below the deepest folder that contains them all.
// Precondition: there is a view.
std::vector<std::filesystem::path> photograph_names(const Survey& survey);

// The view whose photograph_names() is `name`. If there is none, the views of the photographs whose
// path ends with `name`, in whole names of folders and files.
std::vector<std::size_t> views_named(const std::string& name, const Survey& survey);

}  // namespace axial::survey
