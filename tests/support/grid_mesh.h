// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of a grid of vertices.
#pragma once

#include <functional>

#include "scene/mesh.h"

namespace axial::test {

// The mesh of (steps + 1)^2 vertices vertex(i, j), row by row, with two triangles in each square.
// They are counter-clockwise if i goes to the right and j upwards.
inline Mesh grid_mesh(int steps, const std::function<Eigen::Vector3d(int i, int j)>& vertex) {
  Mesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) mesh.vertices.push_back(vertex(i, j).cast<float>());
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

}  // namespace axial::test
