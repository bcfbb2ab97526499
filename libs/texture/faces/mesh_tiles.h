// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles of a mesh that is textured tile by tile, and parts of a mesh.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud/tiles.h"
#include "scene/mesh.h"

namespace axial::texture {

// The tiles, and the faces of each tile.
struct FaceTiles {
  std::vector<cloud::Tile> boxes;      // at least one; together they fill space
  std::vector<std::uint32_t> of_face;  // one per face: index of its tile. Empty for one tile.

  std::size_t count() const { return boxes.size(); }
};

// Divides a mesh into `count` tiles with about equal numbers of vertices (make_tiles() in
// cloud/tiles.h), with the axes `axes` (its rows). A face belongs to the tile that contains its
// middle. Tiles without faces are possible. Precondition: `count` is at least 1, and check_mesh()
// accepts the mesh.
FaceTiles divide_faces(const Mesh& mesh, std::size_t count, const Eigen::Matrix3d& axes);

// The memory [bytes] of divide_faces() with its result.
std::uint64_t bytes_to_divide(const Mesh& mesh, std::size_t count);

// Some faces of a mesh, as a mesh.
struct MeshPart {
  Mesh mesh;                            // without colours; with the marks of its faces
  std::vector<std::uint32_t> vertices;  // one per vertex of `mesh`: its index in the whole mesh
};

// Returns the mesh of the faces with the given indices, in this order. The vertices are those of
// the faces. They keep their positions and their order.
MeshPart mesh_of_faces(const Mesh& mesh, std::span<const std::uint32_t> faces);

// The memory [bytes] of mesh_of_faces() with its result. `vertices`: at most this many vertices of
// the result.
std::uint64_t bytes_of_part(std::uint64_t vertices, std::uint64_t faces);

// Returns the faces of a tile in ascending order. Precondition: there is more than one tile.
std::vector<std::uint32_t> faces_of(const FaceTiles& tiles, std::size_t tile);

}  // namespace axial::texture
