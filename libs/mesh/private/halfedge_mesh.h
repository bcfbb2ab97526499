// SPDX-License-Identifier: GPL-3.0-or-later
// The half-edge mesh of CGAL, on which clean() works. This header takes seconds to compile.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::mesh {

using HalfedgeKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HalfedgeMesh = CGAL::Surface_mesh<HalfedgeKernel::Point_3>;

// Converts a mesh. Faces that name a vertex twice are dropped. If more than two faces or faces of
// different orientation meet at an edge, one of all faces with the same three corners is kept, and
// vertices are duplicated there.
HalfedgeMesh to_halfedges(const Mesh& mesh);
// Converts a mesh back. Removes vertices without faces from `mesh` first. The other vertices are
// renumbered.
Mesh from_halfedges(HalfedgeMesh& mesh);

inline Eigen::Vector3d position(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex) {
  const HalfedgeKernel::Point_3& p = mesh.point(vertex);
  return {p.x(), p.y(), p.z()};
}
Eigen::Vector3d mean_of_neighbours(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex);
// Moves `vertex` to `to`, rounded to float. Meshes are written as float; because of the rounding,
// checks of the half-edge mesh also hold for the file.
void move_to(HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex, const Eigen::Vector3d& to);

// Collapses edges until about `faces` faces are left (Garland and Heckbert's quadrics).
void decimate(HalfedgeMesh& mesh, std::size_t faces);

// Makes triangles with edges of about `edge_length` [m] (isotropic remeshing).
void remesh(HalfedgeMesh& mesh, double edge_length);

// Chooses vertices; an empty function chooses none.
using VertexFilter = std::function<bool(HalfedgeMesh::Vertex_index)>;

// Closes holes whose border has at most `most` edges and none of the vertices that `open` chooses.
// Returns the number of closed holes.
std::size_t close_holes(HalfedgeMesh& mesh, std::size_t most, const VertexFilter& open = {});

// The faces that intersect another face, ascending.
std::vector<HalfedgeMesh::Face_index> intersecting_faces(const HalfedgeMesh& mesh);
// `faces` and the faces that share a corner with them, ascending.
std::vector<HalfedgeMesh::Face_index> with_neighbours(const HalfedgeMesh& mesh,
                                                      std::vector<HalfedgeMesh::Face_index> faces);

// Moves vertices at the same place apart: each moves by 1 % of the way to the mean of its
// neighbours. The vertices that `fixed` chooses stay.
void separate_copies(HalfedgeMesh& mesh, const VertexFilter& fixed = {});
// Makes the mesh free of self-intersections. Faces that intersect others are smoothed up to 8
// times. Faces that still intersect others are removed, and then spikes are removed. Returns the
// number of all removed faces.
std::size_t untangle(HalfedgeMesh& mesh);
// Removes faces with at least two border edges until no such face is left. Then duplicates each
// vertex at which faces touch without a common edge, and moves the copies apart (separate_copies).
// Returns the number of removed faces.
std::size_t remove_spikes(HalfedgeMesh& mesh);

}  // namespace axial::mesh
