// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/mesh_data.h"

#include <gtest/gtest.h>

#include "view/byte_source.h"

namespace axial::view {
namespace {

using testing::ByteSource;

// A part of a mesh as its corners, face by face.
struct CornerData {
  std::vector<Eigen::Vector3f> places;
  std::vector<Eigen::Vector2f> uv;  // fractions of the texture
  std::vector<Rgb> colors;
};

CornerData corners_of(const MeshPart& part) {
  ByteSource source(part.bytes);
  std::vector<Eigen::Vector3f> places(part.vertices);
  for (auto& place : places)
    for (float& x : place) x = source.take<float>();
  std::vector<std::uint32_t> faces(3 * part.faces);
  for (std::uint32_t& vertex : faces) vertex = source.take<std::uint32_t>();
  std::vector<Eigen::Vector2f> uv(part.texture >= 0 ? part.vertices : 0);
  for (auto& place : uv)
    for (float& x : place) x = static_cast<float>(source.take<std::uint16_t>()) / 65535;
  std::vector<Rgb> colors(part.colors ? part.vertices : 0);
  for (Rgb& color : colors)
    for (std::uint8_t& value : color) value = source.take<std::uint8_t>();
  EXPECT_TRUE(source.at_end());
  CornerData corners;
  for (const std::uint32_t vertex : faces) {
    corners.places.push_back(places.at(vertex));
    if (!uv.empty()) corners.uv.push_back(uv.at(vertex));
    if (!colors.empty()) corners.colors.push_back(colors.at(vertex));
  }
  return corners;
}

Mesh square() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}};
  return mesh;
}

TEST(MeshParts, OfAPlainMeshHoldItsFaces) {
  Mesh mesh = square();
  mesh.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  const std::vector<MeshPart> parts = mesh_parts(mesh, 2);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].vertices, 4u);
  EXPECT_EQ(parts[1].vertices, 3u);
  std::size_t face = 0;
  for (const MeshPart& part : parts) {
    const CornerData corners = corners_of(part);
    for (std::size_t k = 0; k < corners.places.size(); ++k) {
      const std::uint32_t vertex = mesh.faces[face + k / 3][k % 3];
      EXPECT_EQ(corners.places[k], mesh.vertices[vertex]);
      EXPECT_EQ(corners.colors[k], mesh.colors[vertex]);
    }
    face += part.faces;
  }
  EXPECT_EQ(face, mesh.faces.size());
}

TEST(MeshParts, HaveOneTextureEachAndSplitVerticesAtSeams) {
  TexturedMesh mesh;
  mesh.mesh = square();
  mesh.textures = {cv::Mat3b(20, 10), cv::Mat3b(100, 50)};
  mesh.texture_of = {0, 0, 1};
  // The second face has other coordinates at the vertices 0 and 2 than the first face.
  mesh.uv = {{{{-0.5f, -0.5f}, {9.5f, -0.5f}, {9.5f, 19.5f}}},
             {{{2, 3}, {4, 5}, {6, 7}}},
             {{{10, 20}, {30, 40}, {20, 30}}}};
  const std::vector<MeshPart> parts = mesh_parts(mesh, 100);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].vertices, 6u);
  std::size_t face = 0;
  for (const MeshPart& part : parts) {
    EXPECT_EQ(static_cast<std::uint32_t>(part.texture), mesh.texture_of[face]);
    const cv::Size size = mesh.textures[static_cast<std::size_t>(part.texture)].size();
    const CornerData corners = corners_of(part);
    for (std::size_t k = 0; k < corners.places.size(); ++k) {
      EXPECT_EQ(corners.places[k], mesh.mesh.vertices[mesh.mesh.faces[face + k / 3][k % 3]]);
      const Eigen::Vector2f uv = mesh.uv[face + k / 3][k % 3];
      EXPECT_NEAR(corners.uv[k].x(), (uv.x() + 0.5f) / static_cast<float>(size.width), 1e-5);
      EXPECT_NEAR(corners.uv[k].y(), (uv.y() + 0.5f) / static_cast<float>(size.height), 1e-5);
    }
    face += part.faces;
  }
}

TEST(MeshParts, MarkedFacesHaveAColourOfTheirOwn) {
  Mesh mesh = square();
  mesh.unseen = {0, 1, 0};
  const std::vector<MeshPart> parts = mesh_parts(mesh, 10);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_FALSE(parts[0].colors);
  EXPECT_EQ(parts[0].faces, 2u);
  ASSERT_TRUE(parts[1].colors);
  const CornerData corners = corners_of(parts[1]);
  EXPECT_EQ(corners.colors, std::vector<Rgb>(3, kUnseenColor));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corners.places[k], mesh.vertices[mesh.faces[1][k]]);
}

}  // namespace
}  // namespace axial::view
