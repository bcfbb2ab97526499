// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a board under water: finds the files, and the corners of the board in each
// photograph.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "calibrate/board.h"
#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// Returns the photographs of `input`, in the order of `input`. A path of a file is returned as it
// is, whatever its extension. A folder is replaced by its files with the extension of an image, in
// the order of their names. Throws an Error for a path that does not exist, and for a folder
// without photographs.
std::vector<std::filesystem::path> photographs_in(std::span<const std::filesystem::path> input);

// Finds the corners of the board in every photograph. Returns one view per photograph, in the order
// of `photographs`. A view has the name of the photograph's file, and no corners if the board is
// not found. Throws an Error that names the first photograph that cannot be read or differs in size
// from the lens. `bit_depth`, and `bit_depth_name`, its name in messages: as for
// io::common_bit_depth.
std::vector<View> find_views(std::span<const std::filesystem::path> photographs, const Board& board,
                             const io::ColmapCamera& lens, int bit_depth = 0,
                             const std::string& bit_depth_name = "bit_depth");

}  // namespace axial::calibrate
