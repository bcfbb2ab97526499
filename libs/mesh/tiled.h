// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the mesh of a large cloud in tiles: the memory is that of the largest tile, and several
// machines can make tiles of one cloud.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "mesh/cloud_source.h"
#include "mesh/reconstruct.h"

namespace axial::mesh {

struct TileRun {
  std::size_t tiles = 2;         // number of tiles, at least 1
  std::filesystem::path folder;  // of the intermediate files; it is created if it is missing
  // Identifies the cloud, the scene and the options. Intermediate files of runs with another
  // identifier, margin or number of tiles are not used.
  std::string made_from;
  // The mesh of a tile is made from the points of the tile and of its surroundings up to this
  // distance [px], above 0. The unit is the width of a pixel at the points of the tile: the 95th
  // percentile of MergedPoints::pixel_widths. The reason: the cut of the graph depends on points
  // far away, but less and less. The default was measured (docs/mesh.md).
  double margin = 150;
};

// Makes the mesh of `cloud` as reconstruct() does, but in tiles:
//
//   1. The cloud is divided into boxes with about equal numbers of points (make_tiles() in
//      cloud/tiles.h; with the axes of Scene::region, or of the world without a region).
//   2. The points of each tile are merged. Points of two tiles are not merged with each other.
//   3. The mesh of each tile and its margin is made and cleaned. The tile keeps the faces that
//      belong to it (owned_part() in tile_mesh.h).
//   4. The tiles are joined (join_tiles()).
//
// Where the meshes of two tiles are the same near their border, the result has the faces of both
// tiles there, without a seam. Limits that depend on mean or median lengths of edges are found for
// each tile. The results of the steps are files in TileRun::folder. A run continues with the files
// of an earlier run. The result is the same whether one run or several made the tiles, and for any
// number of threads.
//
// Throws the Errors of reconstruct(), with these differences: a tile may have fewer than four
// points or no surface; all points of a tile and its margin in a plane are an Error; the limit of
// memory holds for each tile and for the joined mesh. Throws an Error if a file cannot be written,
// or if CleanOptions::decimate, target_faces or edge_length ask for other triangles: they would
// differ at both sides of a border.
Mesh reconstruct_in_tiles(const CloudSource& cloud, const Scene& scene,
                          const ReconstructOptions& options, const TileRun& run,
                          const Context& context = {});

// Makes the file of tile `tile` (from 0) in TileRun::folder, and the files that it needs, unless
// they are there. Other runs may make other tiles at the same time. Errors as above.
void reconstruct_tile(std::size_t tile, const CloudSource& cloud, const Scene& scene,
                      const ReconstructOptions& options, const TileRun& run,
                      const Context& context = {});

// Removes all intermediate files in TileRun::folder, and the folder if it has no other files. No
// other run may use the folder.
void remove_intermediate_files(const TileRun& run);

}  // namespace axial::mesh
