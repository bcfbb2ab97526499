// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "targets/search.h"

namespace axial::apps {

// Returns the photographs of `input`, in the order of their names. The photographs of a folder are
// the images in it and in its subfolders; their names are relative to the folder. Throws an Error
// for a path that does not exist, for a folder without photographs, and for equal names.
std::vector<targets::NamedPhotograph> photographs_of(std::span<const std::filesystem::path> input);

}  // namespace axial::apps
