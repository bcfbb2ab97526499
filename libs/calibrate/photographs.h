// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a board under water: which files they are, and where the board is in them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "calibrate/board.h"
#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// The photographs: given files as they are, and of each folder the files with an image's extension,
// in the order of names. Error for a path that does not exist, and for a folder without
// photographs.
std::vector<std::filesystem::path> photographs_in(std::span<const std::filesystem::path> input);

// The board's corners in every photograph, in the order of `photographs`; without corners where the
// board is not found. A view has the name of its photograph's file. Error that names the first
// photograph that cannot be read or whose size differs from the lens's. `bit_depth` and its
// name in messages: as for io::common_bit_depth.
std::vector<View> find_views(std::span<const std::filesystem::path> photographs, const Board& board,
                             const io::ColmapCamera& lens, int bit_depth = 0,
                             const std::string& bit_depth_name = "bit_depth");

}  // namespace axial::calibrate
