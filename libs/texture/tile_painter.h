// SPDX-License-Identifier: GPL-3.0-or-later
// Makes textured meshes from charts, tile by tile.
#pragma once

#include <span>
#include <vector>

#include "texture/atlas/atlas.h"
#include "texture/colors/leveling.h"
#include "texture/faces/face_labels.h"
#include "texture/faces/mesh_tiles.h"

namespace axial::texture {

// Gives each chart to the tile with most of its faces; of several such tiles, to the first. Moves
// the faces of the chart to this tile.
ChartTiles give_charts(FaceTiles& tiles, const Charts& charts);

class TilePainter {
 public:
  // `tiles`: after give_charts(), whose result is `of_charts`. run() moves `mesh` away if there is
  // one tile. Other arguments than `of_charts` and `budget` must outlive the object. `budget`: what
  // the arguments leave. Error if it does not suffice to write the meshes of all tiles.
  TilePainter(Mesh& mesh, const Charts& charts, std::span<const FacePair> pairs,
              const FaceTiles& tiles, ChartTiles of_charts, const Sources& sources,
              const MemoryBudget& budget);

  // The number of charts that are scaled down.
  std::size_t scaled_down() const { return atlas_.scaled_down; }

  // Paints, levels and gives the meshes of all tiles. If there are several tiles and seams, each
  // tile is painted twice: to compare the colours at the seams, and for the result.
  void run(const TileSink& take);

 private:
  bool levelled() const;
  std::uint64_t bytes_of_corrections() const;
  void check_writing() const;
  Corrections corrections_of_all();
  void paint_tile(std::size_t tile);
  TexturedMesh assemble(std::size_t tile);

  Mesh& mesh_;
  const Charts& charts_;
  const FaceTiles& tiles_;
  const Sources& sources_;
  std::vector<Seam> seams_;
  Atlas atlas_;
  MemoryBudget budget_;
  MemoryBudget::Reservation of_atlas_;        // and of the seams, without textures
  MemoryBudget::Reservation of_corrections_;  // until the end
};

}  // namespace axial::texture
