// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ files as other programs write them, and our own without textures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/images/image.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using Face = std::array<std::uint32_t, 3>;
using V = Eigen::Vector3f;

class ReadObjTest : public test::FolderTest {
 protected:
  void SetUp() override {
    write_png(folder_ / "t.png", cv::Mat3b(16, 32, cv::Vec3b(1, 2, 3)));
    write("m.mtl", "newmtl wall\nmap_Kd t.png\n");
  }

  void write(const char* name, const std::string& text) const {
    write_atomically(folder_ / name, text);
  }
  TexturedMesh read(const std::string& obj) const {
    write("m.obj", obj);
    return read_textured_mesh(folder_ / "m.obj");
  }
  std::string error(const std::string& obj) const {
    return test::error_of([&] { read(obj); });
  }
  // The texture coordinates of a face with (u, v) = (0, 0), (1, 0), (0, 1) and the line `map`.
  TexturedMesh with_map(const std::string& map) const {
    write("m.mtl", "newmtl wall\n" + map + "\n");
    return read(kStart + "usemtl wall\nf 1/1 2/2 3/3\n");
  }

  const std::string kPoints =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n";
  const std::string kStart = "mtllib m.mtl\n" + kPoints;
};

// (u, v) with v from the lower edge.
Eigen::Vector2f obj_uv(const TexturedMesh& mesh, std::size_t corner) {
  const cv::Size size = mesh.textures[mesh.texture_of[0]].size();
  const Eigen::Vector2f pixel = mesh.uv[0][corner];
  return {(pixel.x() + 0.5f) / static_cast<float>(size.width),
          1 - (pixel.y() + 0.5f) / static_cast<float>(size.height)};
}

TEST_F(ReadObjTest, OurOwnMeshWithoutTextures) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.1f, 1, 7}}, {}, {{0, 1, 2}, {2, 1, 0}}};
  write_mesh(folder_ / "own.obj", mesh, LocalFrame{{500000, 4e6, 0}});
  EXPECT_FALSE(is_textured_mesh(folder_ / "own.obj"));
  const Mesh again = read_mesh_of_scene(LocalFrame{{500000, 4e6, -1}}, folder_ / "own.obj");
  EXPECT_EQ(again.faces, mesh.faces);
  EXPECT_EQ(again.vertices[2], V(0.1f, 1, 8));
  EXPECT_TRUE(again.colors.empty());
  EXPECT_EQ(mesh_place(folder_ / "own.obj").first_vertex, Eigen::Vector3d(500000, 4e6, 0));
  EXPECT_THAT(files_of_mesh(folder_ / "own.obj"), ElementsAre(folder_ / "own.obj"));
}

TEST_F(ReadObjTest, NegativeIndicesCountBackFromTheLine) {
  const TexturedMesh mesh =
      read(kStart + "usemtl wall\nf -4/-4 -3/-3 -2/-2\nv 9 9 9\nf -5/1 -4/2 -1/-1\n");
  EXPECT_THAT(mesh.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 1, 4}));
  EXPECT_EQ(mesh.uv[0][1], mesh.uv[1][1]);
  EXPECT_THAT(error(kStart + "usemtl wall\nf -5/-4 -3/-3 -2/-2\n"), HasSubstr("the vertex '-5'"));
  EXPECT_THAT(error(kStart + "usemtl wall\nf 0/1 1/1 2/1\n"), HasSubstr("the vertex '0'"));
  EXPECT_THAT(error(kStart + "usemtl wall\nf 99999999999999999999/1 1/1 2/1\n"),
              HasSubstr("does not exist"));
}

TEST_F(ReadObjTest, EveryFormOfLines) {
  const std::string body =
      "usemtl wall\r\nf 1/1/1 2/2/1 4/4/1 \\\r\n  3/3/1  # a square\r\ng top \\\n side\ns off\n"
      "l 1 2\np 3\nvp 0 0\nf 1/1 2/2 3/3\n";
  for (const std::string& start : {kStart, std::string("# exported\n\n\t\n") + kStart}) {
    const TexturedMesh mesh = read(start + body);
    EXPECT_THAT(mesh.mesh.faces, ElementsAre(Face{0, 1, 3}, Face{0, 3, 2}, Face{0, 1, 2}));
  }
  // usemtl before mtllib; faces before vertices; coordinates of one number.
  const TexturedMesh early = read(
      "usemtl wall\nf 1/1/1 2/2/1 3/1/1\nmtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25\n"
      "vt 1 0.5 0\nvn 0 0 1\n");
  EXPECT_LT((obj_uv(early, 0) - Eigen::Vector2f(0.25f, 0)).norm(), 1e-6);
  EXPECT_LT((obj_uv(early, 1) - Eigen::Vector2f(1, 0.5f)).norm(), 1e-6);
  EXPECT_THAT(error(kStart + "surf 0 1 0 1 1 2\n"), HasSubstr("'surf' is not supported"));
  EXPECT_THAT(error(kStart + "f 1/1 2/2 \\\n"), HasSubstr("corner is missing"));
}

TEST_F(ReadObjTest, OptionsOfMapsMoveCoordinates) {
  for (const char* map :
       {"map_Kd -o 0.25 -s 0.5 0.5 t.png", "map_Kd -s 0.5 0.5 1 -o 0.25 0 0 t.png",
        "map_kd -blendu on -bm 0.5 -mm 0 1 -boost 2 -s 0.5 0.5 -texres 512 "
        "-cc off -o 0.25 t.png"}) {
    const TexturedMesh mesh = with_map(map);
    EXPECT_LT((obj_uv(mesh, 0) - Eigen::Vector2f(0.25f, 0)).norm(), 1e-6) << map;
    EXPECT_LT((obj_uv(mesh, 1) - Eigen::Vector2f(0.75f, 0)).norm(), 1e-6) << map;
    EXPECT_LT((obj_uv(mesh, 2) - Eigen::Vector2f(0.25f, 0.5f)).norm(), 1e-6) << map;
  }
  // A scale of 2 shows the picture twice along each axis, or its edge.
  EXPECT_EQ(with_map("map_Kd -s 2 2 t.png").textures[0].size(), cv::Size(64, 32));
  EXPECT_EQ(with_map("map_Kd -clamp on -s 2 2 t.png").textures[0].size(), cv::Size(32, 16));
  const auto error_of_map = [&](const std::string& map) {
    return test::error_of([&] { with_map(map); });
  };
  EXPECT_THAT(error_of_map("map_Kd -clamp maybe t.png"), HasSubstr("m.mtl: line 2: -clamp is"));
  EXPECT_THAT(error_of_map("map_Kd -o t.png"), HasSubstr("m.mtl: line 2: -o has no number"));
  EXPECT_THAT(error_of_map("map_Kd -t 1 t.png"), HasSubstr("option -t of map_Kd is not supported"));
  EXPECT_THAT(error_of_map("map_Kd -s 1 1 1"), HasSubstr("map_Kd names no file"));
  EXPECT_THAT(error_of_map("map_Kd none.png"), HasSubstr("none.png"));
  EXPECT_THAT(error_of_map(std::string("map_Kd t.png\0.png", 17)),
              EndsWith("m.mtl: line 2: the name of a file contains a NUL byte"));
}

TEST_F(ReadObjTest, FilesAreFoundAsOtherSystemsNameThem) {
  fs::create_directories(folder_ / "Textures");
  write_png(folder_ / "Textures" / "My Wall 2.PNG", cv::Mat3b(2, 2, cv::Vec3b(9, 9, 9)));
  for (const char* name : {"Textures/My Wall 2.PNG", "textures\\my wall 2.png",
                           "\"Textures/My Wall 2.PNG\"", "./TEXTURES/MY WALL 2.png"}) {
    const TexturedMesh mesh = with_map(std::string("map_Kd ") + name);
    EXPECT_EQ(mesh.textures[0].size(), cv::Size(2, 2)) << name;
    EXPECT_THAT(texture_files_of(folder_ / "m.obj").textures,
                ElementsAre(testing::ResultOf([](const fs::path& path) { return path.filename(); },
                                              fs::path("My Wall 2.PNG"))));
  }
  const std::string elsewhere[] = {(folder_ / "t.png").string(),
                                   "../" + folder_.filename().string() + "/t.png"};
  for (const std::string& name : elsewhere)
    EXPECT_EQ(with_map("map_Kd " + name).textures[0].size(), cv::Size(32, 16)) << name;
  EXPECT_EQ(with_map("map_Kd C:\\scans\\reef\\T.PNG").textures[0].size(), cv::Size(32, 16));
  // A name that two files have in another case is not guessed.
  write_png(folder_ / "T.png", cv::Mat3b(2, 2, cv::Vec3b(9, 9, 9)));
  EXPECT_THAT(test::error_of([&] { with_map("map_Kd T.PNG"); }), HasSubstr("T.PNG"));
}

TEST_F(ReadObjTest, SeveralMaterialFiles) {
  write("b c.mtl", "newmtl floor\nKd 0 0.5 1\n");
  const std::string faces = "usemtl wall\nf 1/1 2/2 3/3\nusemtl floor\nf 2 4 3\n";
  for (const char* line :
       {"mtllib m.mtl b c.mtl\n", "mtllib  b c.mtl   m.mtl\n", "mtllib m.mtl\nmtllib B C.mtl\n"}) {
    const TexturedMesh mesh = read(line + kPoints + faces + "usemtl\nf 2 4 3\n");
    ASSERT_EQ(mesh.textures.size(), 3u);
    EXPECT_EQ(mesh.textures[mesh.texture_of[0]](0, 0), cv::Vec3b(1, 2, 3));
    EXPECT_EQ(mesh.textures[mesh.texture_of[1]](0, 0), cv::Vec3b(255, 128, 0));  // Kd
    EXPECT_EQ(mesh.textures[mesh.texture_of[2]](0, 0), cv::Vec3b(255, 255, 255));
    EXPECT_NE(mesh.uv[1][0], mesh.uv[1][1]);
    EXPECT_EQ(texture_files_of(folder_ / "m.obj").materials.size(), 2u);
  }
  EXPECT_THAT(error("mtllib none.mtl\n"), HasSubstr("none.mtl"));
  EXPECT_THAT(error("mtllib m.mtl none.mtl\n"), HasSubstr("none.mtl"));
  EXPECT_THAT(error(std::string("mtllib m.mtl\0\n", 14)), HasSubstr("line 1: the name of a file"));
  // Without the MTL file the shape can be read; the file that is named belongs to the mesh.
  write("m.obj", "mtllib none.mtl\n" + kPoints + faces);
  EXPECT_EQ(read_shape(folder_ / "m.obj").faces.size(), 2u);
  EXPECT_THAT(files_of_mesh(folder_ / "m.obj"),
              ElementsAre(folder_ / "m.obj", folder_ / "none.mtl"));
}

// Programs write the line mtllib in front of each object.
TEST_F(ReadObjTest, ARepeatedMaterialFileIsReadOnce) {
  const std::string object = "mtllib m.mtl\nusemtl wall\nf 1/1 2/2 3/3\n";
  EXPECT_EQ(read(kPoints + object + object + object).textures.size(), 1u);
}

// Each of the 100,000 beginnings of the line could be the name of a file.
TEST_F(ReadObjTest, ALongListOfMaterialFilesEnds) {
  std::string line = "mtllib";
  for (int i = 0; i < 100'000; ++i) line += " x";
  EXPECT_THAT(error(line + "\n" + kPoints + "f 1 2 3\n"), HasSubstr("cannot be"));
}

TEST_F(ReadObjTest, VerticesHaveColours) {
  write("m.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 1\nv 0 1 0 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(read_shape(folder_ / "m.obj").colors,
              ElementsAre(Rgb{255, 128, 0}, Rgb{0, 0, 255}, Rgb{0, 255, 0}));
  write("m.obj", "v 0 0 0 255 128 0\nv 1 0 0 0 0 255\nv 0 1 0 0 255 0\nf 1 2 3\n");
  EXPECT_EQ(read_shape(folder_ / "m.obj").colors[0], (Rgb{255, 128, 0}));
  write("m.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 1.0\nv 0 1 0\nf 1 2 3\n");  // a weight, nothing
  EXPECT_TRUE(read_shape(folder_ / "m.obj").colors.empty());
}

// The memory of short lines is much more than their text.
TEST_F(ReadObjTest, TheMemoryOfShortLinesIsCounted) {
  std::string text;
  for (int k = 0; k < 3000; ++k) text += "v 1 2 3\nvt 0\n";
  for (int k = 0; k < 5000; ++k) text += "f 1 2 3\n";
  text += "f 1 2 3 \\\n4 5 6\n";
  write("m.obj", text);
  EXPECT_GE(bytes_to_read_mesh(folder_ / "m.obj"),
            text.size() + 3000 * (24 + 12 + 16) + 5004 * (12 + 24 + 4));
}

TEST_F(ReadObjTest, DamagedFilesAreRefusedOrRead) {
  write("m.mtl", "newmtl wall\nmap_Kd -s 2 2 t.png\n");
  const std::string good = kStart + "usemtl wall\nf -4/1 -3/2 -2/3 \\\n 4/4\n";
  test::expect_damage_survived(folder_ / "m.obj", good, [&](const fs::path& file) {
    try {
      read_textured_mesh(file);
    } catch (const Error& error) {  // names the OBJ, or an MTL file that it names
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(folder_.string())) << message;
      fail("{}: {}", file.string(), message);
    }
  });
}

}  // namespace
}  // namespace axial::io
