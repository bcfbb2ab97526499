// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes for the tests of maps.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scene/mesh.h"

namespace axial::test {

// A grid of cells x cells rectangles over the rectangle from `low` to `high`, at the heights
// height(x, y). Each cell is two faces, which meet along the diagonal from low x, y to high x, y.
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
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      mesh.faces.push_back({a, a + 1, a + cells + 2});
      mesh.faces.push_back({a, a + cells + 2, a + cells + 1});
    }
  return mesh;
}

// Appends the vertices and faces of `part` to `mesh`.
inline void append(Mesh& mesh, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.faces) mesh.faces.push_back({first + a, first + b, first + c});
}

}  // namespace axial::test
