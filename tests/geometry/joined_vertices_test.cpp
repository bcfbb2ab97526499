// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/joined_vertices.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/vertex_bends.h"
#include "support/grid_mesh.h"

namespace axial::geometry {
namespace {

// A grid of vertices at random heights.
Mesh rough_grid(int steps) {
  std::mt19937 random(5);
  std::normal_distribution<double> height(0, 0.1);
  return test::grid_mesh(steps,
                         [&](int i, int j) { return Eigen::Vector3d(i, j, height(random)); });
}

// Vertices of its own for each face, after those of the mesh.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup{mesh.vertices, {}, {}};
  for (const auto& face : mesh.faces) {
    const auto next = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : face) soup.vertices.push_back(mesh.vertices[corner]);
    soup.faces.push_back({next, next + 1, next + 2});
  }
  return soup;
}

TEST(JoinVertices, GivesTheSharedVerticesOfASoup) {
  const Mesh mesh = rough_grid(12);
  Mesh joined = soup_of(mesh);
  EXPECT_NE(joined.faces, mesh.faces);
  join_vertices(joined);
  EXPECT_EQ(joined.faces, mesh.faces);
  const std::vector<float> bends = vertex_bends(mesh), of_joined = vertex_bends(joined);
  EXPECT_TRUE(std::equal(bends.begin(), bends.end(), of_joined.begin()));
}

TEST(JoinVertices, LeavesVerticesAtDifferentPlaces) {
  Mesh mesh = rough_grid(12);
  const auto faces = mesh.faces;
  join_vertices(mesh);
  EXPECT_EQ(mesh.faces, faces);
}

}  // namespace
}  // namespace axial::geometry
