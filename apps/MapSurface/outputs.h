// SPDX-License-Identifier: GPL-3.0-or-later
// The files that MapSurface writes, and those of earlier runs that it removes.
#pragma once

#include <span>
#include <string>

#include "axial/map.h"
#include "settings.h"
#include "survey/survey.h"

namespace axial::apps {

// The maps with the pixels `grid`, their copies, and profiles. `crs`: of the map, as WKT; empty:
// none. Errors of map::require_widths() and map::read_lines() are passed on.
map::MapFiles map_files(const Settings& settings, const survey::Survey& survey,
                        const map::MapGrid& grid, const std::string& crs);

// The file that stands for all, to lock them.
std::filesystem::path first_file(const Settings& settings);

// Removes files of an earlier run that this run does not write: they belong to another map. A file
// that does not state that it is such a file stays, and so does one that lies beside it by chance.
void remove_stale_files(const Settings& settings, std::span<const std::filesystem::path> written);

}  // namespace axial::apps
