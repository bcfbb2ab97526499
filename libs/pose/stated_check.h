// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the numbers that an adjustment found with the numbers that were measured.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pose/adjust.h"

namespace axial::pose {

// Returns one line for each free number that differs from its measured value by more than three of
// its standard deviations before the adjustment. `ports`: the name of the port of each camera.
std::vector<std::string> lines_of_moved_numbers(const Bundle& refined,
                                                std::span<const std::string> ports,
                                                const AdjustOptions& options);

}  // namespace axial::pose
