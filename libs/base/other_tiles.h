// SPDX-License-Identifier: GPL-3.0-or-later
// Files of tiles that a run with another number of tiles wrote.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace axial {

// Returns the files beside `output` that are named as tiles of another number of tiles: <output
// without extension>.tileI-N.EXT, where N is not `tiles` and EXT is a known extension
// (output_name.h). They are sorted by their names. A folder that cannot be read has none.
std::vector<std::filesystem::path> other_tiles(const std::filesystem::path& output,
                                               std::size_t tiles);

// Warns of tiles that a run has not renewed, in one line; says nothing if there are none. They
// stay, because nothing tells whether the user has changed them.
void warn_of_other_tiles(const std::vector<std::filesystem::path>& tiles);

}  // namespace axial
