// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "calibrate/board.h"
#include "calibrate/board_bundle.h"

// The photographs: files as they are, and of folders what is an image by its name, in the order of
// names. Error for a path that does not exist, or where there is none at all.
std::vector<std::filesystem::path> photographs_in(std::span<const std::filesystem::path> input);

// The board's corners in every photograph, in their order, without any where it is not found.
// Error that names the first photograph which cannot be read, or is not of the lens's size.
// `bit_depth`: of io::common_bit_depth.
std::vector<axial::calibrate::View> find_views(std::span<const std::filesystem::path> photographs,
                                               const axial::calibrate::Board& board,
                                               const axial::io::ColmapCamera& lens,
                                               int bit_depth = 0);
