// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a board under water: finds the files, and the corners of the board in each
// photograph.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "axial/base.h"
#include "calibrate/board.h"
#include "calibrate/board_bundle.h"

namespace axial::calibrate {

// Returns the photographs of `input`, in the order of `input`. A path of a file is returned as it
// is, whatever its extension. A folder is replaced by its files (not those of its subfolders) with
// the extension .jpg, .jpeg, .png, .tif, .tiff or .bmp in upper or lower case, in the order of
// their names. Throws an Error for a path that does not exist, and for a folder without
// photographs.
std::vector<std::filesystem::path> photographs_in(std::span<const std::filesystem::path> input);

// Finds the corners of the board in every photograph, by see_board() (see_board.h). Returns one
// view for each photograph, in the order of `photographs`. A view has the name of the photograph's
// file, without its folder. Corners are not sought in transparent pixels. Throws an Error that
// names a photograph that cannot be read or differs in size from `lens`. If there are several such
// photographs, it is the same one for any number of threads. `bit_depth`: the number of bits, from
// 8 to 16, that the values of 16-bit photographs use. 0: as many bits as the largest value in all
// photographs needs, but at least 8 (io::common_bit_depth, whose lines `context` gets).
std::vector<View> find_views(std::span<const std::filesystem::path> photographs, const Board& board,
                             const io::ColmapCamera& lens, int bit_depth = 0,
                             const Context& context = {});

}  // namespace axial::calibrate
