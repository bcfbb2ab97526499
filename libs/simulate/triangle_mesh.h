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

// World frame, metres; outward normals see the corners counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  // Of the thin structure that a vertex is part of [m], 0 for all else; empty where nothing is
  // thin.
  std::vector<float> thickness = {};
};

// Appends `part` to `mesh`.
void append(TriangleMesh& mesh, const TriangleMesh& part);

// Removes the faces whose three corners are all hidden, and vertices no face uses any more.
// `hidden(p)` is called once a vertex, in parallel.
void remove_hidden(TriangleMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& hidden);

// Area-weighted unit normals, one a vertex.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

// A grid of rows x columns vertices, vertex (r, c) given by `at(r, c)` (called in parallel).
// Triangles see (row direction) x (column direction) as outward. `wrap_columns` joins the last
// column to the first.
TriangleMesh grid_mesh(std::size_t rows, std::size_t columns, bool wrap_columns,
                       const std::function<Eigen::Vector3d(std::size_t, std::size_t)>& at);

// The unit sphere: an icosahedron whose faces are split in four `levels` times.
TriangleMesh unit_sphere(int levels);

}  // namespace axial::simulate
