// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "axial/map.h"

namespace axial::map {

using geometry::PosedCamera;

// The memory [bytes] of median_pixel_width().
std::uint64_t bytes_of_pixel_width(const Mesh& mesh);

}  // namespace axial::map
