// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace axial::geometry {
namespace {

// Two faces with a common edge along x: one of the area 1/2 with the normal z, one of the area 1
// with the normal -y. The last vertex has no face.
TEST(VertexNormals, AreWeightedByTheAreasOfTheFaces) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -2}, {5, 5, 5}};
  mesh.faces = {{0, 1, 2}, {1, 0, 3}};
  const auto normals = vertex_normals(mesh);
  ASSERT_EQ(normals.size(), 5u);
  constexpr float kRounding = 4 * std::numeric_limits<float>::epsilon();
  const Eigen::Vector3f both = Eigen::Vector3f(0, -2, 1) / std::sqrt(5.0f);
  EXPECT_LE((normals[0] - both).norm(), kRounding) << normals[0].transpose();
  EXPECT_LE((normals[1] - both).norm(), kRounding);
  EXPECT_LE((normals[2] - Eigen::Vector3f(0, 0, 1)).norm(), kRounding);
  EXPECT_LE((normals[3] - Eigen::Vector3f(0, -1, 0)).norm(), kRounding);
  EXPECT_EQ(normals[4], Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace axial::geometry
