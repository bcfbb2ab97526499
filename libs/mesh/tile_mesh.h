// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a mesh that belongs to a tile, and the union of the parts of all tiles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloud/tiles.h"
#include "mesh/clean.h"
#include "scene/mesh.h"

namespace axial::mesh {

// Some faces of a mesh. The vertices are in the order in which the faces name them.
struct MeshPart {
  Mesh mesh;
  std::vector<std::uint32_t> vertices;  // one per vertex of `mesh`: its index in the whole mesh
};

// The faces that `taken` marks, in their order.
MeshPart part_of(const Mesh& mesh, const std::vector<bool>& taken);

// The directed edges (directed()) of the faces that `taken` marks, ascending.
std::vector<std::uint64_t> directed_edges(const Mesh& mesh, const std::vector<bool>& taken);
inline std::uint64_t directed(std::uint32_t from, std::uint32_t to) {
  return std::uint64_t{from} << 32 | to;
}

// The faces of a mesh that belong to a tile.
struct TileMesh {
  Mesh mesh;
  // The edges at which the faces of the tile meet faces of other tiles. The two vertices are in the
  // order in which the face of this tile passes them.
  std::vector<std::array<std::uint32_t, 2>> seams;
};

// Returns the faces of `mesh` that belong to `tile`: the faces whose centroid the tile contains.
// The centroid depends on the positions of the corners, and not on their order. So each face of a
// mesh belongs to exactly one tile of make_tiles() (cloud/tiles.h), and a face that two meshes have
// belongs to the same tile in both. Vertices without faces are left out. Precondition: at most two
// faces of `mesh` meet at an edge, and they are oriented.
TileMesh owned_part(const Mesh& mesh, const cloud::Tile& tile);

struct JoinOptions {
  // Pieces are removed if the diagonal of their bounding box is below this many mean edge lengths.
  double spurious = 20;  // 0: none is removed
};

struct JoinReport {
  // Edges between tiles. An edge that two tiles have counts once.
  std::size_t seams = 0;
  // Of these: edges that have no counterpart in another tile, because the meshes of the two tiles
  // differ there.
  std::size_t unmatched = 0;
  std::size_t replaced_faces = 0;      // faces around unmatched edges, which were mended
  std::size_t removed_components = 0;  // pieces below the spurious limit
};

// Joins the meshes of all tiles. Each mesh is the part of its tile (owned_part) of a mesh of the
// tile and its surroundings. If another tile has the same seam in the opposite direction, each end
// of the seam becomes one vertex with the same end in the other tile. The same ends are at most a
// thousandth of the seam's length apart. Where a seam has no counterpart, the faces around it are
// mended: gaps of at most 60 edges are closed, and faces that intersect other faces of the
// neighbourhood are replaced or removed. All other faces stay as they are. If the faces at a vertex
// are not connected by common edges any more, each connected group gets a vertex of its own. The
// result is edge- and vertex-manifold and oriented if each mesh is. The vertices are in the order
// of the tiles; the new vertices follow.
Mesh join_tiles(std::vector<TileMesh> tiles, const JoinOptions& options = {},
                JoinReport* report = nullptr);

// The memory [bytes] of join_tiles() with its result and its arguments.
std::uint64_t bytes_to_join(std::uint64_t vertices);

}  // namespace axial::mesh
