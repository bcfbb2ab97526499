// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace axial::simulate {

using Face = std::array<std::uint32_t, 3>;

// A mesh in the world frame [m]. Seen from outside, the corners of a face are counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  // The thickness [m] of the thin structure to which each vertex belongs, 0 for other vertices.
  // Empty if there are no thin structures.
  std::vector<float> thickness = {};
};

// Appends `part` to `mesh`: its vertices follow those of `mesh`, and its faces those of `mesh`. If
// only one of the two has `thickness`, the vertices of the other get the thickness 0.
void append(TriangleMesh& mesh, const TriangleMesh& part);

// Removes the faces whose three corners are all hidden, and then the vertices without faces. The
// order of the remaining faces stays, the order of the vertices may change. `hidden(p)` tells
// whether a vertex at `p` is hidden; it is called once for each vertex, in parallel.
void remove_hidden(TriangleMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& hidden);

// Area-weighted unit normals, one for each vertex. Zero for a vertex without faces.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

// Makes a grid of rows x columns vertices, at least 1 x 1. Vertex (r, c) has the index r * columns
// + c and the position at(r, c), which is called in parallel. The outward normal is (direction of
// growing r) x (direction of growing c). With `wrap_columns` the last column is joined to the
// first.
TriangleMesh grid_mesh(std::size_t rows, std::size_t columns, bool wrap_columns,
                       const std::function<Eigen::Vector3d(std::size_t, std::size_t)>& at);

// Makes a sphere with radius 1 around the origin: an icosahedron whose faces are split into four
// `levels` times. All vertices lie on the sphere.
TriangleMesh unit_sphere(int levels);

}  // namespace axial::simulate
