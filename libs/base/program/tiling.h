// SPDX-License-Identifier: GPL-3.0-or-later
// Results that are made in tiles, in less memory or by several runs: the options --tiles N and
// --tile I/N, and the names of the files of tiles.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "axial/base.h"
#include "base/context.h"
#include "base/program/program.h"

namespace axial {

inline constexpr std::size_t kMostTiles = 1000;

struct Tiling {
  std::size_t count = 1;              // number of tiles; 1: the result is made in one piece
  std::optional<std::size_t> tile{};  // from 1: the run makes this tile alone; empty: all tiles
};

// The setting and its value in messages: "tile 2/4" if the run makes one tile, otherwise "tiles 4".
// Both settings are marked (setting()).
std::string text_of(const Tiling& tiling);

// Throws an Error with text_of() unless `count` is from 1 to kMostTiles and `tile` is from 1 to
// `count`.
void check(const Tiling& tiling);

// Takes the value "I/N" of --tile. `tiling.count` is the value of --tiles. Error if the value has
// another form, if it is not a tile of at most kMostTiles tiles, or if --tiles is given and is not
// N.
void take_tile(const std::string& value, const ParsedOptions& parsed, Tiling& tiling);

// The file of tile `tile` (from 1) of `tiles` tiles of `output`, which has a known extension
// (output_name.h): <output>.tileI-N with `extension` (".ply").
std::filesystem::path tile_file(const std::filesystem::path& output, std::size_t tile,
                                std::size_t tiles, const std::string& extension);

// Returns the files beside `output` that are named as tiles of another number of tiles: <output
// without extension>.tileI-N.EXT, where N is not `tiles` and EXT is a known extension. They are
// sorted by their names. A folder that cannot be read has none.
std::vector<std::filesystem::path> other_tiles(const std::filesystem::path& output,
                                               std::size_t tiles);

// Warns of tiles that a run has not renewed, in one line; says nothing if there are none. They
// stay, because nothing tells whether the user has changed them.
void warn_of_other_tiles(const std::vector<std::filesystem::path>& tiles, const Context& context);

}  // namespace axial
