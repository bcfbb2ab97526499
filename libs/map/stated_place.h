// SPDX-License-Identifier: GPL-3.0-or-later
// The coordinates of a map as its file states them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "map/world_axes.h"

namespace axial::map {

// What the file of a map states about its coordinates.
struct StatedPlace {
  std::optional<WorldAxes> axes;  // empty: not stated
  std::string crs;                // WKT; empty: none
};

// Reads no pixels. Error that names the file if it cannot be read, and for malformed axes.
StatedPlace stated_place(const std::filesystem::path& path);

}  // namespace axial::map
