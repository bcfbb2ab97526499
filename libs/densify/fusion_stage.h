// SPDX-License-Identifier: GPL-3.0-or-later
// The fusion of depth maps to a cloud, in one piece or tile by tile. Each tile is a file, so that
// several machines can fuse tiles of one scene, and a run that was stopped continues where it
// ended.
#pragma once

#include <cstddef>

#include "densify/run.h"
#include "densify/tiles.h"

namespace axial::densify {

// Fuses the final depth maps of Project::references to one cloud and writes the cloud beside the
// scene OutputOptions::scene. The options decide whether the cloud is cropped to the region of
// interest, and whether it has colours and normals. Returns the number of points of the cloud.
// With more than one tile (FusionOptions::tiles), or if the file of the only tile exists, the maps
// are fused tile by tile: tiles whose files are missing, or were made from other depth maps or
// options, are made first. Then the points of all tiles are written, in the order of the tiles. The
// files of the tiles stay. So the cloud has the same bytes whether this run or others made the
// tiles. Otherwise the maps are fused in one piece. The cloud is written as it grows, unless its
// colours or normals are estimated from the whole cloud (estimate_colors or estimate_normals is 1).
// A line tells how many points are supported by only two depth maps. Unless
// OutputOptions::report is empty, an entry "fusion" in this file tells the same. The file must
// exist: check_agreement() writes it. Calls map_large_blocks() (base/memory.h). Throws an Error if
// a map or an image cannot be read, if a file cannot be written, or if the views of a tile need
// more memory than the plan has for them.
std::size_t write_cloud(const Run& run, const FusionOptions& options, const OutputOptions& output);

// Makes a tile and writes its file (tiles.h), unless the file is there already and was made from
// the same depth maps with the same options. `tile`: from 1 to FusionOptions::tiles. Returns the
// number of points. First reads every depth map once, to find the views that see each tile. Errors
// as for write_cloud().
std::size_t write_tile(const Run& run, const FusionOptions& options, const OutputOptions& output,
                       std::size_t tile);

}  // namespace axial::densify
