// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of the images of a scene to use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>

#include "scene/scene.h"

namespace axial::survey {

// Reads a text file that names an image of `scene` in each line: by its ID, its path, or the name
// of its file with or without extension. Empty lines and lines that begin with # are ignored.
// Returns the indices of the images. Error for a file that cannot be read, and for a line that
// names no image.
std::set<std::size_t> images_in(const std::filesystem::path& file, const Scene& scene);

}  // namespace axial::survey
