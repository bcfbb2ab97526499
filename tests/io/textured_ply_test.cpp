// SPDX-License-Identifier: GPL-3.0-or-later
// Textured PLY files of other programs: coordinates at vertices, polygons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/images/image.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Face = std::array<std::uint32_t, 3>;

class TexturedPlyTest : public test::FolderTest {
 protected:
  void SetUp() override {
    write_png(folder_ / "t.png", cv::Mat3b(10, 20, cv::Vec3b(1, 2, 3)));
    write_png(folder_ / "u.png", cv::Mat3b(20, 40, cv::Vec3b(4, 5, 6)));
  }

  // A square of two triangles or of one polygon.
  fs::path write(const std::string& comments, const std::string& vertex, const std::string& face,
                 const std::vector<std::string>& vertices, const std::vector<std::string>& faces) {
    std::string text = "ply\nformat ascii 1.0\n" + comments +
                       "element vertex 4\nproperty float x\n" +
                       "property float y\nproperty float z\n" + vertex + "element face " +
                       std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\n" +
                       face + "end_header\n";
    for (const std::string& line : vertices) text += line + "\n";
    for (const std::string& line : faces) text += line + "\n";
    write_atomically(folder_ / "m.ply", text);
    return folder_ / "m.ply";
  }

  const std::vector<std::string> kSquare{"0 0 0 0 0", "1 0 0 1 0", "1 1 0 1 1", "0 1 0 0.25 0.75"};
};

// u and v of 0.25 and 0.75 in a texture of 20 x 10 pixels, whose v counts from the lower edge.
const Eigen::Vector2f kPlace{0.25f * 20 - 0.5f, 0.25f * 10 - 0.5f};

TEST_F(TexturedPlyTest, CoordinatesAtVertices) {
  for (const auto& [u, v] :
       {std::pair{"texture_u", "texture_v"}, {"s", "t"}, {"u", "v"}, {"texture_s", "texture_t"}}) {
    const std::string properties =
        std::string("property float ") + u + "\nproperty float " + v + "\n";
    const fs::path file =
        write("comment TextureFile t.png\n", properties, "", kSquare, {"3 0 1 2", "3 0 2 3"});
    EXPECT_TRUE(is_textured_mesh(file)) << u;
    const TexturedMesh mesh = read_textured_mesh(file);
    EXPECT_THAT(mesh.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 2, 3}));
    EXPECT_EQ(mesh.uv[1][2], kPlace) << u;
    EXPECT_GE(bytes_to_read_mesh(file), 40 * mesh.mesh.faces.size());
    // Blender writes no name of a texture: the file is a mesh without textures.
    EXPECT_FALSE(is_textured_mesh(write("", properties, "", kSquare, {"3 0 1 2", "3 0 2 3"})));
    EXPECT_EQ(read_shape(file).faces.size(), 2u);
  }
}

TEST_F(TexturedPlyTest, NumbersOfTexturesAtVerticesAndPolygons) {
  std::vector<std::string> vertices = kSquare;
  for (std::string& line : vertices) line += " 1";
  const std::string properties = "property float s\nproperty float t\nproperty int texnumber\n";
  const std::string names = "comment TextureFile t.png\ncomment TextureFile U.PNG\n";
  const TexturedMesh mesh =
      read_textured_mesh(write(names, properties, "", vertices, {"4 0 1 2 3"}));
  EXPECT_THAT(mesh.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 2, 3}));
  EXPECT_THAT(mesh.texture_of, ElementsAre(1u, 1u));
  EXPECT_EQ(mesh.uv[1][2], Eigen::Vector2f(0.25f * 40 - 0.5f, 0.25f * 20 - 0.5f));
  EXPECT_THAT(texture_files_of(folder_ / "m.ply").textures,
              ElementsAre(folder_ / "t.png", folder_ / "u.png"));
}

TEST_F(TexturedPlyTest, PolygonsWithCoordinatesAtTheirCorners) {
  const std::vector<std::string> vertices{"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  const auto read = [&](const std::string& face) {
    return read_textured_mesh(write("comment TextureFile t.png\n", "",
                                    "property list uchar float texcoord\nproperty int texnumber\n",
                                    vertices, {face}));
  };
  const TexturedMesh mesh = read("4 0 1 2 3 8 0 0 1 0 1 1 0.25 0.75 0");
  EXPECT_THAT(mesh.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 2, 3}));
  EXPECT_EQ(mesh.uv[1][0], mesh.uv[0][0]);
  EXPECT_EQ(mesh.uv[1][2], kPlace);
  EXPECT_THAT(test::error_of([&] { read("4 0 1 2 3 6 0 0 1 0 1 1 0"); }),
              HasSubstr("6 numbers in texcoord, expected 8"));
  EXPECT_THAT(test::error_of([&] { read("4 0 1 2 3 8 0 0 1 0 1 1 0 0 -1"); }),
              HasSubstr("texnumber -1"));
}

// Corners of all triangles are in the same order seen from one side.
TEST_F(TexturedPlyTest, StripsOfTriangles) {
  write_atomically(folder_ / "m.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                   "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                   "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 3 2 1\n");
  EXPECT_TRUE(ply_has_faces(folder_ / "m.ply"));
  EXPECT_THAT(read_shape(folder_ / "m.ply").faces,
              ElementsAre(Face{0, 1, 2}, Face{2, 1, 3}, Face{3, 2, 1}));
}

// Strips have neither marks nor texture coordinates. A file may have faces, too, in either order.
TEST_F(TexturedPlyTest, StripsBesideFaces) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string faces =
      "element face 1\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nproperty uchar unseen\n";
  const std::string strip = "4 0 1 2 3\n", face = "3 0 1 2 6 0 0 1 0 0 1 1\n";
  const auto write_mesh = [&](const std::string& elements, const std::string& rows) {
    write_atomically(folder_ / "m.ply",
                     "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 4\n"
                     "property float x\nproperty float y\nproperty float z\n" +
                         elements + "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n" + rows);
  };
  write_mesh(faces + strips, face + strip);
  EXPECT_THAT(read_shape(folder_ / "m.ply").unseen, ElementsAre(1, 0, 0));
  write_mesh(strips + faces, strip + face);
  EXPECT_THAT(read_shape(folder_ / "m.ply").unseen, ElementsAre(0, 0, 1));
  EXPECT_THAT(test::error_of([&] { read_textured_mesh(folder_ / "m.ply"); }),
              HasSubstr("3 triangles, but texture coordinates of 1"));
}

TEST_F(TexturedPlyTest, ATextureWithoutCoordinatesMakesNoTexturedMesh) {
  const fs::path file = write("comment TextureFile t.png\n", "", "",
                              {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}, {"3 0 1 2"});
  EXPECT_FALSE(is_textured_mesh(file));
}

TEST_F(TexturedPlyTest, ANameWithANulByteIsRefused) {
  write_atomically(folder_ / "m.ply",
                   std::string("ply\nformat ascii 1.0\ncomment TextureFile t.png") + '\0' +
                       "\nelement vertex 0\nend_header\n");
  EXPECT_THAT(test::error_of([&] { textures_of_ply(folder_ / "m.ply"); }),
              HasSubstr("m.ply: line 3: the name of a file contains a NUL byte"));
}

}  // namespace
}  // namespace axial::io
