// SPDX-License-Identifier: GPL-3.0-or-later
// Fusion tile by tile. Each tile is a file, so that several machines can fuse tiles of one scene,
// and a run that was stopped continues where it ended.
#pragma once

#include <filesystem>

#include "densify/fusion_run.h"

namespace axial::densify {

// Throws an Error unless every reference has a complete final depth map that this program made from
// the same input with the same settings. The error names the first map that does not.
void require_final_maps(const Project& project, const Settings& settings,
                        const ExistingMaps& existing);

// Makes tile Settings::tile and writes its file (tile_files.h), unless the file is there already
// and was made from the same depth maps with the same settings. Returns the numbers of points.
CloudCounts write_tile(const FusionRun& run);

// Makes the tiles whose files are missing or were made from other depth maps or settings. Then
// writes the points of all tiles, in the order of the tiles, to the cloud `ply`. The files of the
// tiles stay. So the cloud has the same bytes whether this run or others made the tiles.
// Returns the numbers of points.
//
// Both functions first read every depth map once, to find the views that see each tile. They throw
// an Error if a map or an image cannot be read, if a file cannot be written, or if the views of a
// tile need more memory than the plan has for them.
CloudCounts write_tiles(const FusionRun& run, const std::filesystem::path& ply);

}  // namespace axial::densify
