// SPDX-License-Identifier: GPL-3.0-or-later
// The half-edge mesh of CGAL, in which meshes are mended. Takes seconds to compile.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>
#include <span>

#include "scene/mesh.h"

namespace axial::mesh {

using HalfedgeKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HalfedgeMesh = CGAL::Surface_mesh<HalfedgeKernel::Point_3>;

// Faces that are degenerate in their indices are dropped. Where more than two faces meet at an
// edge, or faces of different orientation, vertices are duplicated.
HalfedgeMesh to_halfedges(const Mesh& mesh);
// Renumbers the vertices in the order of the half-edge mesh, without removed ones.
Mesh from_halfedges(HalfedgeMesh& mesh);

inline Eigen::Vector3d position(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex) {
  const HalfedgeKernel::Point_3& p = mesh.point(vertex);
  return {p.x(), p.y(), p.z()};
}
Eigen::Vector3d mean_of_neighbours(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex);
// Positions stay representable as float, because a mesh is written as float: a check of the
// half-edge mesh then holds for the file.
void move_to(HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index vertex, const Eigen::Vector3d& to);

// simplify.cpp
void decimate(HalfedgeMesh& mesh, std::size_t faces);
void remesh(HalfedgeMesh& mesh, double edge_length);

// untangle.cpp
// Moves vertices at the same place apart, each by 1 % of the way to the mean of its neighbours.
void separate_copies(HalfedgeMesh& mesh);
// Makes the mesh free of self-intersections. Faces that intersect others are smoothed up to 8
// times, and then removed, with the spikes that this leaves. Returns the number of removed faces.
std::size_t untangle(HalfedgeMesh& mesh);
// Removes faces with two border edges, until there are none, and splits the vertices at which only
// corners of faces meet. Returns the number of removed faces.
std::size_t remove_spikes(HalfedgeMesh& mesh);

}  // namespace axial::mesh
