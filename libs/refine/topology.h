// SPDX-License-Identifier: GPL-3.0-or-later
// The neighbourhoods of a mesh's vertices, and the normals, edge lengths and areas of the vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/lists.h"
#include "scene/mesh.h"

namespace axial::refine {

// The neighbourhoods of the vertices. The neighbours of a vertex are the vertices to which an edge
// leads from it.
struct Topology {
  geometry::Lists<> faces;       // for each vertex, its faces in ascending order
  geometry::Lists<> neighbours;  // for each vertex, its neighbours in ascending order
  std::vector<bool> border;      // the vertex has an edge that does not belong to exactly two faces
};

// Precondition: check_mesh() accepts the mesh (scene/check_mesh.h).
Topology topology_of(const Mesh& mesh);

// Normals, edge lengths and areas, one of each per vertex [mesh units].
struct Shape {
  // For every vertex, a unit normal: the normalised sum of the area-weighted normals of the vertex
  // and of its neighbours. Zero if the sum is zero, for example because all faces have no area.
  // Because of the averaging, neighbours have similar normals, and vertices that move along their
  // normals do not cross each other.
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> edge;  // root of the mean squared length of the vertex's edges
  std::vector<float> area;  // a third of the area of the vertex's faces
};

// Computes the Shape of `mesh`, whose Topology is `topology`.
Shape shape_of(const Mesh& mesh, const Topology& topology);

// Twice the area of the face, times its unit normal. `face`: the indices of its corners.
inline Eigen::Vector3f face_vector(const Mesh& mesh, const std::array<std::uint32_t, 3>& face) {
  const Eigen::Vector3f& a = mesh.vertices[face[0]];
  return (mesh.vertices[face[1]] - a).cross(mesh.vertices[face[2]] - a);
}

}  // namespace axial::refine
