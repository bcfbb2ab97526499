// SPDX-License-Identifier: GPL-3.0-or-later
// The plane with relief: meshes over a regular grid, for the tests of every library.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "scene/mesh.h"

namespace axial::test {

// The faces of a grid of columns x rows cells, whose vertices are listed row by row. Each cell is
// two faces, which meet along the diagonal from its lower left to its upper right corner. Their
// fronts are turned to +z.
inline std::vector<std::array<std::uint32_t, 3>> grid_faces(std::uint32_t columns,
                                                            std::uint32_t rows) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i;
      faces.push_back({a, a + 1, a + columns + 2});
      faces.push_back({a, a + columns + 2, a + columns + 1});
    }
  return faces;
}

// The surface z = height(x, y) over the rectangle from `low` to `high`, as a grid of cells x cells
// cells (grid_faces()).
template <class Height>
Mesh height_field(const Eigen::Vector2d& low, const Eigen::Vector2d& high, std::uint32_t cells,
                  const Height& height) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = low.x() + (high.x() - low.x()) * i / cells;
      const double y = low.y() + (high.y() - low.y()) * j / cells;
      mesh.vertices.push_back(Eigen::Vector3d(x, y, height(x, y)).cast<float>());
    }
  mesh.faces = grid_faces(cells, cells);
  return mesh;
}

// A level square with the given middle, as a grid.
inline Mesh level_square(const Eigen::Vector3d& middle, double side, std::uint32_t cells = 1) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(side / 2), at = middle.head<2>();
  return height_field(at - half, at + half, cells, [&](double, double) { return middle.z(); });
}

// Turns the fronts of all faces to the other side.
inline Mesh flipped(Mesh mesh) {
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

// Appends the vertices and faces of `part` to `mesh`.
inline void append(Mesh& mesh, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.faces) mesh.faces.push_back({first + a, first + b, first + c});
}

}  // namespace axial::test
