// SPDX-License-Identifier: GPL-3.0-or-later
// The views of all faces of a mesh, chosen in one piece or tile by tile.
//
// Tile by tile, the faces of a tile are labelled together with the faces around the tile, because a
// view that is good for the faces on both sides of a border needs no seam there. The faces around
// the tile are those whose middle is nearer to the tile than kMarginInEdges times the median length
// of an edge. A face keeps the label that its own tile gives it. Faces that an earlier tile has
// labelled keep their labels, and seams towards them have their cost.
//
// All faces of the mesh can hide a face of any tile. The qualities and colours of the views of a
// face are therefore the same as in one piece, and so are the outliers. Only the choice between the
// views can differ, because it is made for fewer faces at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "axial/texture.h"
#include "texture/faces/adjacency.h"
#include "texture/faces/mesh_tiles.h"

namespace axial::texture {

inline constexpr double kMarginInEdges = 30;

// What texture_mesh() was given besides the mesh.
struct Sources {
  std::span<const View> views;
  const ImageSource& images;
  const Options& options;
  const Context& context;

  // The same budget, with errors that tell that a larger number of tiles needs less memory.
  MemoryBudget less_by_tiles(const MemoryBudget& budget) const;
};

// Returns the label of each face (labels.h). `pairs`: the result of face_pairs(). Sets
// Report::outliers. Errors as for texture_mesh(). `budget`: besides the mesh, `pairs` and `tiles`.
std::vector<std::uint32_t> label_faces(const Mesh& mesh, std::span<const FacePair> pairs,
                                       const FaceTiles& tiles, const Sources& sources,
                                       const MemoryBudget& budget, Report& report);

}  // namespace axial::texture
