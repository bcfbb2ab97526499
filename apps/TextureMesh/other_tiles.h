// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>

namespace axial::apps {

// Warns of meshes beside `output` that are tiles of another number of tiles: files with names
// <output without extension>.tileI-N.EXT where N is not `tiles`. A run with `tiles` tiles has not
// renewed them. They stay, because nothing tells whether the user has changed them.
void warn_of_other_tiles(const std::filesystem::path& output, std::size_t tiles);

}  // namespace axial::apps
