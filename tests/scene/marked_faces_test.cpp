// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/marked_faces.h"

#include <gmock/gmock.h>

namespace axial {
namespace {

using Faces = std::vector<std::array<std::uint32_t, 3>>;

Mesh strip() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  mesh.colors = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  mesh.faces = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}};
  return mesh;
}

TEST(MarkedFaces, AreRemovedWithTheVerticesThatOnlyTheyUse) {
  Mesh mesh = strip();
  mesh.unseen = {1, 0, 0};
  EXPECT_EQ(remove_marked_faces(mesh), 1u);
  EXPECT_EQ(mesh.faces, (Faces{{1, 0, 2}, {1, 2, 3}}));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(mesh.colors.front()[0], 1);
  EXPECT_TRUE(mesh.unseen.empty());
}

TEST(MarkedFaces, WithoutMarksNothingChanges) {
  Mesh mesh = strip();
  mesh.vertices.emplace_back(9.0f, 9.0f, 9.0f);  // no face uses it
  EXPECT_EQ(remove_marked_faces(mesh), 0u);
  EXPECT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.faces, strip().faces);
}

TEST(MarkedFaces, OfATexturedMeshTakeTheirTextureCoordinatesAlong) {
  TexturedMesh mesh;
  mesh.mesh = strip();
  mesh.mesh.unseen = {0, 1, 0};
  mesh.textures.resize(2);
  for (float f = 0; f < 3; ++f) mesh.uv.push_back({{{f, 0}, {f, 1}, {f, 2}}});
  mesh.texture_of = {0, 1, 1};
  EXPECT_EQ(remove_marked_faces(mesh), 1u);
  EXPECT_EQ(mesh.mesh.faces, (Faces{{0, 1, 2}, {2, 3, 4}}));
  EXPECT_THAT(mesh.texture_of, testing::ElementsAre(0, 1));
  ASSERT_EQ(mesh.uv.size(), 2u);
  EXPECT_EQ(mesh.uv[1][0], Eigen::Vector2f(2, 0));
}

}  // namespace
}  // namespace axial
