// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and textured meshes that end at a boundary.
#pragma once

#include <cstdint>

#include "axial/scene_images.h"
#include "boundary/boundary.h"
#include "scene/mesh.h"

namespace axial::boundary {

// The mark (Mesh::unseen) of faces outside of a boundary.
inline constexpr std::uint8_t kOutside = 2;

// Splits the faces of the mesh along the boundary (cut_faces()), and marks those outside with
// kOutside; faces that were marked before and lie inside keep their marks. Faces stay in their
// order, and the pieces of a face follow each other at its place. Pieces have the texture
// coordinates of their face. Returns the number of faces outside. Error that names the boundary and
// both extents if no face is inside. Precondition: check_mesh() accepts the mesh.
std::size_t mark_outside(Mesh& mesh, const Boundary& boundary);
std::size_t mark_outside(TexturedMesh& mesh, const Boundary& boundary);

// The memory [bytes] of mark_outside(), besides the mesh, if few faces are split.
std::uint64_t bytes_to_mark(const Mesh& mesh);

// The indices of the faces that are marked with kOutside, in ascending order.
std::vector<std::uint32_t> outside_faces(const Mesh& mesh);

// Removes the faces that are marked with kOutside, and the vertices that no face uses then. Other
// marks stay if there are some.
void remove_outside(Mesh& mesh);
void remove_outside(TexturedMesh& mesh);

}  // namespace axial::boundary
