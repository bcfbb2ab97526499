// SPDX-License-Identifier: GPL-3.0-or-later
// The files of fused tiles. A tile's cloud (.ply) has a side file (.json), which says from what the
// tile was made.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "densify/fusion_run.h"
#include "densify/settings.h"

namespace axial::densify {

// The file of tile `tile` (from 1) of Settings::fusion_tiles tiles: <output>.tileI-N.ply beside the
// output. Its side file has ".json" added to the name.
std::filesystem::path tile_file(const Settings& settings, std::size_t tile);

// The clouds and side files of the tiles that a run may write or use: of Settings::tile, or of all
// tiles if it is 0.
std::vector<std::filesystem::path> tile_outputs(const Settings& settings);

// Writes the side file of the cloud `ply`, which is complete. `made_from`: a text that identifies
// the tile's inputs and settings. The side file also tells the box of the tile, for people and
// tests: rotation (row by row), low and high, with null for a side at infinity.
void finish_tile(const std::filesystem::path& ply, const std::string& made_from,
                 const CloudCounts& counts, const cloud::Tile& tile);

// The numbers of points of a tile. Empty if the cloud or its side file is missing or damaged, or if
// the tile was made from something else.
std::optional<CloudCounts> finished_tile(const std::filesystem::path& ply,
                                         const std::string& made_from);

// Removes the cloud and its side file.
void remove_tile(const std::filesystem::path& ply);

// Removes the tiles of the output, whose cloud is complete: the tiles of Settings::fusion_tiles
// tiles, and those of other numbers of tiles whose side file tells that this program wrote them and
// that nobody changed them. Warns of other clouds with the name of a tile.
void remove_tiles(const Settings& settings);

}  // namespace axial::densify
