// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/textured/textured_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/atomic_file.h"
#include "io/images/image.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class TexturedMeshTest : public test::FolderTest {
 protected:
  std::string bytes(const std::string& name) const { return read_file(folder_ / name); }

  fs::path path_ = folder_ / "a mesh.ply";
};

// Two squares of two triangles, 10 apart, each with a texture of its own or both with one.
TexturedMesh two_squares(std::size_t textures) {
  TexturedMesh mesh;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const float x = 10 * static_cast<float>(k);
    mesh.mesh.vertices.insert(mesh.mesh.vertices.end(),
                              {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    const std::uint32_t first = 4 * k;
    mesh.mesh.faces.push_back({first, first + 1, first + 2});
    mesh.mesh.faces.push_back({first, first + 2, first + 3});
    mesh.uv.push_back({{{1.5f, 2.5f}, {5, 2.5f}, {5, 7}}});
    mesh.uv.push_back({{{1.5f, 2.5f}, {5, 7}, {1.5f, 7}}});
    for (int i = 0; i < 2; ++i) mesh.texture_of.push_back(textures > 1 ? k : 0);
  }
  for (std::size_t k = 0; k < textures; ++k) {
    cv::Mat3b& texture = mesh.textures.emplace_back(16, 32);
    cv::randu(texture, 0, 255);
  }
  return mesh;
}

template <class T>
T value_at(const std::string& data, std::size_t at) {
  T value;
  std::memcpy(&value, data.data() + at, sizeof(T));
  return value;
}

TEST_F(TexturedMeshTest, PlyHasTheLayoutOfOpenMVS) {
  write_textured_mesh(path_, two_squares(1), TexturedFormat::ply);
  const std::string ply = bytes("a mesh.ply");
  EXPECT_THAT(ply, HasSubstr("comment TextureFile a mesh0.png\n"));
  EXPECT_THAT(ply, HasSubstr("property list uint8 float32 texcoord\n"));
  EXPECT_THAT(ply, testing::Not(HasSubstr("texnumber")));
  const std::size_t body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), body + 8 * 12 + 4 * 38);
  const std::size_t face = body + 8 * 12;
  EXPECT_EQ(ply[face], 3);
  EXPECT_EQ(value_at<std::uint32_t>(ply, face + 9), 2u);
  EXPECT_EQ(ply[face + 13], 6);
  // u = (x + 0.5) / width, v = 1 - (y + 0.5) / height
  EXPECT_FLOAT_EQ(value_at<float>(ply, face + 14), 2 / 32.0f);
  EXPECT_FLOAT_EQ(value_at<float>(ply, face + 18), 1 - 3 / 16.0f);
}

TEST_F(TexturedMeshTest, PlyIsReadAgain) {
  for (const std::size_t textures : {1u, 2u}) {
    const TexturedMesh mesh = two_squares(textures);
    write_textured_mesh(path_, mesh, TexturedFormat::ply);
    const TexturedMesh again = read_textured_ply(path_);
    EXPECT_EQ(again.mesh.vertices, mesh.mesh.vertices);
    EXPECT_EQ(again.mesh.faces, mesh.mesh.faces);
    EXPECT_EQ(again.texture_of, mesh.texture_of);
    ASSERT_EQ(again.textures.size(), textures);
    for (std::size_t k = 0; k < textures; ++k)
      EXPECT_EQ(cv::norm(again.textures[k], mesh.textures[k], cv::NORM_INF), 0);
    for (std::size_t f = 0; f < mesh.uv.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT((again.uv[f][k] - mesh.uv[f][k]).norm(), 1e-5) << f;
  }
}

// The corners of a face: positions and texture coordinates. A GLB has other vertices than the mesh.
void expect_same_faces(const TexturedMesh& mesh, const TexturedMesh& again) {
  ASSERT_EQ(again.mesh.faces.size(), mesh.mesh.faces.size());
  ASSERT_EQ(again.textures.size(), mesh.textures.size());
  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    EXPECT_EQ(cv::norm(again.textures[again.texture_of[f]], mesh.textures[mesh.texture_of[f]],
                       cv::NORM_INF),
              0);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(again.mesh.vertices[again.mesh.faces[f][k]],
                mesh.mesh.vertices[mesh.mesh.faces[f][k]]);
      EXPECT_LT((again.uv[f][k] - mesh.uv[f][k]).norm(), 1e-5) << f;
    }
  }
}

TEST_F(TexturedMeshTest, ObjAndGlbAreReadAgain) {
  for (const std::size_t textures : {1u, 2u}) {
    const TexturedMesh mesh = two_squares(textures);
    write_textured_mesh(path_, mesh, TexturedFormat::obj);
    const TexturedMesh obj = read_textured_mesh(folder_ / "a mesh.obj");
    expect_same_faces(mesh, obj);
    EXPECT_EQ(obj.mesh.vertices, mesh.mesh.vertices);
    write_textured_mesh(path_, mesh, TexturedFormat::glb);
    expect_same_faces(mesh, read_textured_mesh(folder_ / "a mesh.glb"));
    write_textured_mesh(path_, mesh, TexturedFormat::gltf);
    expect_same_faces(mesh, read_textured_mesh(folder_ / "a mesh.gltf"));
  }
}

TEST_F(TexturedMeshTest, TheExtensionOrTheHeaderTellsTexturedMeshes) {
  write_textured_mesh(path_, two_squares(1), TexturedFormat::ply);
  EXPECT_TRUE(is_textured_mesh(path_));
  for (const auto format : {TexturedFormat::obj, TexturedFormat::glb, TexturedFormat::gltf}) {
    write_textured_mesh(path_, two_squares(1), format);
    EXPECT_TRUE(is_textured_mesh(textured_files(path_, format, 1)[0]));
  }
  write_mesh_ply(path_, two_squares(1).mesh);
  EXPECT_FALSE(is_textured_mesh(path_));
}

TEST_F(TexturedMeshTest, APlyNamesItsTextures) {
  write_textured_mesh(path_, two_squares(2), TexturedFormat::ply);
  EXPECT_EQ(textures_of_ply(path_), (std::vector<std::string>{"a mesh0.png", "a mesh1.png"}));
  write_mesh_ply(path_, two_squares(1).mesh);
  EXPECT_TRUE(textures_of_ply(path_).empty());
}

TEST_F(TexturedMeshTest, ObjOfOtherProgramsIsRead) {
  io::write_png(folder_ / "t.png", cv::Mat3b(16, 32, cv::Vec3b(1, 2, 3)));
  write_atomically(folder_ / "m.mtl", "# a comment\n\nnewmtl plain\nnewmtl wall\nmap_Kd t.png\n");
  write_atomically(folder_ / "m.obj",
                   "mtllib m.mtl\r\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n"
                   "vt 1 0\nvt 1 1 0\nvt 0 1\nvn 0 0 1\no quad\nusemtl wall\n"
                   "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
  const TexturedMesh mesh = read_textured_obj(folder_ / "m.obj");
  using Face = std::array<std::uint32_t, 3>;
  EXPECT_EQ(mesh.mesh.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.uv[1][2], Eigen::Vector2f(-0.5f, -0.5f));
  const auto error = [&](const std::string& obj) {
    write_atomically(folder_ / "m.obj", obj);
    return test::error_of([&] { read_textured_obj(folder_ / "m.obj"); });
  };
  const std::string start = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\n";
  EXPECT_THAT(error(start), HasSubstr("m.obj: the mesh has no faces"));
  EXPECT_THAT(error(start + "usemtl bad\n"), HasSubstr("line 6: there is no material 'bad'"));
  EXPECT_THAT(error(start + "usemtl wall\nf 1/1 2/1 4/1\n"), HasSubstr("the vertex '4'"));
  EXPECT_THAT(error(start + "usemtl wall\nf 1/1 2/1 -4/1\n"), HasSubstr("the vertex '-4'"));
  EXPECT_THAT(error(start + "usemtl wall\nf 1/1 2/0 3/1\n"), HasSubstr("coordinate '0'"));
  EXPECT_THAT(error(start + "usemtl wall\nf 1 2 3\n"), HasSubstr("no texture coordinate"));
  EXPECT_THAT(error(start + "usemtl wall\nf 1/1 2/1\n"), HasSubstr("corner is missing"));
  EXPECT_THAT(error("v 1 nan 0\n"), HasSubstr("line 1: a coordinate is 'nan'"));
  EXPECT_THAT(error("mtllib none.mtl\n"), HasSubstr("none.mtl"));
}

TEST_F(TexturedMeshTest, WrongGlbIsRefused) {
  write_textured_mesh(path_, two_squares(1), TexturedFormat::glb);
  const std::string good = bytes("a mesh.glb");
  const fs::path file = folder_ / "wrong.glb";
  const auto error = [&](const std::string& glb) {
    write_atomically(file, glb);
    return test::error_of([&] { read_textured_gltf(file); });
  };
  // Replaces text by text of the same length.
  const auto with = [&](const std::string& from, std::string to) {
    to.resize(from.size(), ' ');
    return test::replaced(good, from, to);
  };
  for (std::size_t size = 0; size < good.size(); size += 37)
    EXPECT_THAT(error(good.substr(0, size)), HasSubstr("wrong.glb")) << size;
  EXPECT_THAT(error(with("\"mode\":4", "\"mode\":1")), HasSubstr("the mesh has no faces"));
  EXPECT_THAT(error(with("TEXCOORD_0", "TEXCOORD_1")), HasSubstr("has no TEXCOORD_0"));
  EXPECT_THAT(error(with("\"count\":12", "\"count\":99")), HasSubstr("ends outside of its"));
  const std::size_t at = good.find("\"buffers\":[{");
  const std::string buffer = good.substr(at, good.find('}', at) - at);
  EXPECT_THAT(error(with(buffer, "\"buffers\":[{\"byteLength\":0")),
              HasSubstr("outside of its buffer"));
}

TEST_F(TexturedMeshTest, WrongPlyIsRefused) {
  write_textured_mesh(path_, two_squares(2), TexturedFormat::ply);
  const std::string good = bytes("a mesh.ply");
  const auto error = [&](const std::string& ply) {
    write_atomically(path_, ply);
    return test::error_of([&] { read_textured_ply(path_); });
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    return test::replaced(good, from, to);
  };
  EXPECT_THAT(error(with("TextureFile a mesh0.png", "TextureFile missing.png")),
              HasSubstr("missing.png"));
  EXPECT_THAT(error(with("comment TextureFile a mesh1.png\n", "")), HasSubstr("texnumber 1"));
  EXPECT_THAT(error(with("texcoord", "texcoo_d")), HasSubstr("texcoord"));
  for (std::size_t size = 0; size < good.size(); size += 7)
    EXPECT_THAT(error(good.substr(0, size)), HasSubstr("a mesh.ply"));
}

// OpenMVS 2.3 writes no faces for a mesh without texture and crashes for one texture.
TEST_F(TexturedMeshTest, ObjRefersToItsFiles) {
  for (const std::size_t textures : {1u, 2u}) {
    write_textured_mesh(path_, two_squares(textures), TexturedFormat::obj);
    std::istringstream obj(bytes("a mesh.obj")), mtl(bytes("a mesh.mtl"));
    std::size_t vertices = 0, places = 0, faces = 0, materials = 0, images = 0;
    for (std::string line; std::getline(obj, line);) {
      vertices += line.starts_with("v ");
      places += line.starts_with("vt ");
      faces += line.starts_with("f ");
      if (line.starts_with("mtllib ")) {
        EXPECT_TRUE(fs::exists(folder_ / line.substr(7))) << line;
      }
      if (line.starts_with("usemtl ")) {
        EXPECT_THAT(bytes("a mesh.mtl"), HasSubstr("newmtl " + line.substr(7)));
      }
    }
    for (std::string line; std::getline(mtl, line);) {
      materials += line.starts_with("newmtl ");
      if (!line.starts_with("map_Kd ")) continue;
      ++images;
      EXPECT_EQ(read_image_size(folder_ / line.substr(7)), cv::Size(32, 16));
    }
    EXPECT_EQ(vertices, 8u);
    EXPECT_EQ(places, 8u);
    EXPECT_EQ(faces, 4u);
    EXPECT_EQ(materials, textures);
    EXPECT_EQ(images, textures);
    EXPECT_THAT(bytes("a mesh.obj"), HasSubstr("f 1/1 2/2 3/3\n"));
    EXPECT_THAT(bytes("a mesh.obj"), HasSubstr("vt 0.0625 0.8125\n"));
  }
}

struct Gltf {
  nlohmann::json json;
  std::string buffer;
};

Gltf parts_of_glb(const std::string& glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(value_at<std::uint32_t>(glb, 8), glb.size());
  const auto length = value_at<std::uint32_t>(glb, 12);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  EXPECT_EQ(glb.substr(20 + length + 4, 3), "BIN");
  return {nlohmann::json::parse(glb.substr(20, length)), glb.substr(28 + length)};
}

// The bytes of an accessor's values.
std::string values(const Gltf& gltf, std::size_t accessor, std::size_t bytes) {
  const auto& view =
      gltf.json["bufferViews"][gltf.json["accessors"][accessor]["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["byteLength"], bytes);
  EXPECT_EQ(view.value("byteOffset", 0) % 4, 0);
  return gltf.buffer.substr(view.value("byteOffset", std::size_t{0}), bytes);
}

// In OpenMVS 2.3, the bounds of each primitive are those of the whole mesh.
void check_gltf(const Gltf& gltf, std::size_t textures) {
  const auto& primitives = gltf.json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), textures);
  EXPECT_EQ(gltf.json["materials"].size(), textures);
  EXPECT_EQ(gltf.json["images"].size(), textures);
  EXPECT_EQ(gltf.json["asset"]["version"], "2.0");
  EXPECT_EQ(gltf.buffer.size() / 4 * 4,
            gltf.json["buffers"][0]["byteLength"].get<std::size_t>() / 4 * 4);
  for (std::size_t k = 0; k < textures; ++k) {
    const auto& positions =
        gltf.json["accessors"][primitives[k]["attributes"]["POSITION"].get<std::size_t>()];
    const std::size_t count = textures == 2 ? 4 : 8;
    EXPECT_EQ(positions["count"], count);
    const std::string xyz = values(gltf, primitives[k]["attributes"]["POSITION"], 12 * count);
    float low = 1e9f, high = -1e9f;
    for (std::size_t i = 0; i < count; ++i) {
      low = std::min(low, value_at<float>(xyz, 12 * i));
      high = std::max(high, value_at<float>(xyz, 12 * i));
    }
    EXPECT_EQ(positions["min"][0], low);
    EXPECT_EQ(positions["max"][0], high);
    EXPECT_EQ(high - low, textures == 2 ? 1 : 11);
    const std::string uv = values(gltf, primitives[k]["attributes"]["TEXCOORD_0"], 8 * count);
    EXPECT_FLOAT_EQ(value_at<float>(uv, 0), 2 / 32.0f);
    EXPECT_FLOAT_EQ(value_at<float>(uv, 4), 3 / 16.0f);
    const std::string indices = values(gltf, primitives[k]["indices"], 24 * 2 / textures);
    for (std::size_t i = 0; i < indices.size(); i += 4)
      EXPECT_LT(value_at<std::uint32_t>(indices, i), count);
    const auto& material = gltf.json["materials"][primitives[k]["material"].get<std::size_t>()];
    EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
    EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorTexture"]["index"], k);
  }
}

TEST_F(TexturedMeshTest, GlbContainsEverything) {
  for (const std::size_t textures : {1u, 2u}) {
    write_textured_mesh(path_, two_squares(textures), TexturedFormat::glb);
    const Gltf gltf = parts_of_glb(bytes("a mesh.glb"));
    check_gltf(gltf, textures);
    for (const auto& image : gltf.json["images"]) {
      EXPECT_EQ(image["mimeType"], "image/png");
      const auto& view = gltf.json["bufferViews"][image["bufferView"].get<std::size_t>()];
      write_atomically(folder_ / "held.png",
                       gltf.buffer.substr(view.value("byteOffset", std::size_t{0}),
                                          view["byteLength"].get<std::size_t>()));
      EXPECT_EQ(read_image_size(folder_ / "held.png"), cv::Size(32, 16));
    }
  }
}

TEST_F(TexturedMeshTest, GltfRefersToItsFiles) {
  write_textured_mesh(path_, two_squares(2), TexturedFormat::gltf);
  const Gltf gltf{nlohmann::json::parse(bytes("a mesh.gltf")), bytes("a mesh.bin")};
  check_gltf(gltf, 2);
  EXPECT_EQ(gltf.json["buffers"][0]["uri"], "a%20mesh.bin");
  EXPECT_EQ(gltf.json["images"][1]["uri"], "a%20mesh_gltf1.png");
  EXPECT_TRUE(fs::exists(folder_ / "a mesh_gltf1.png"));
}

TEST_F(TexturedMeshTest, FarFromTheOriginPositionsStayLocal) {
  const LocalFrame frame{{500000, 4e6, -20}};
  const TexturedMesh mesh = two_squares(1);
  for (const auto format : {TexturedFormat::ply, TexturedFormat::obj, TexturedFormat::glb})
    write_textured_mesh(path_, mesh, format, frame);
  for (const char* name : {"a mesh.ply", "a mesh.obj", "a mesh.glb"}) {
    const TexturedMesh again = read_textured_mesh(folder_ / name, frame);
    expect_same_faces(mesh, again);
    const TexturedMesh moved = read_textured_mesh(folder_ / name, LocalFrame{{499990, 4e6, -20}});
    EXPECT_EQ(moved.mesh.vertices[1], again.mesh.vertices[1] + Eigen::Vector3f(10, 0, 0)) << name;
  }
  EXPECT_THAT(bytes("a mesh.obj"), HasSubstr("# geo_offset 500000 4000000 -20\n"));
  const Gltf gltf = parts_of_glb(bytes("a mesh.glb"));
  EXPECT_EQ(gltf.json["nodes"][0]["extras"]["geo_offset"][1], 4e6);
}

TEST_F(TexturedMeshTest, WrongMeshesAreNotWritten) {
  const auto error = [&](auto change) {
    TexturedMesh mesh = two_squares(1);
    change(mesh);
    return test::error_of([&] { write_textured_mesh(path_, mesh, TexturedFormat::glb); });
  };
  EXPECT_THAT(error([](TexturedMesh& m) { m.uv.pop_back(); }), HasSubstr("3 texture coordinates"));
  EXPECT_THAT(error([](TexturedMesh& m) { m.texture_of[2] = 7; }),
              HasSubstr("face 2 has texture 7"));
  EXPECT_THAT(error([](TexturedMesh& m) { m.mesh.faces[1][0] = 9; }), HasSubstr("vertex 9"));
  EXPECT_TRUE(fs::is_empty(folder_));
}

// Two textures of 32 x 16 pixels in 3 bytes, and the decoding of one of them.
TEST_F(TexturedMeshTest, TexturesAreFoundAndCountedWithoutReadingThem) {
  const TexturedMesh mesh = two_squares(2);
  std::vector<std::uint64_t> bytes;
  std::set<fs::path> names;
  std::size_t count = 0;
  for (const TexturedFormat format :
       {TexturedFormat::ply, TexturedFormat::obj, TexturedFormat::glb, TexturedFormat::gltf}) {
    write_textured_mesh(path_, mesh, format);
    const std::vector<fs::path> written = textured_files(path_, format, 2);
    const TextureFiles files = texture_files_of(written[0]);
    std::vector<fs::path> all{written[0]};
    all.insert(all.end(), files.materials.begin(), files.materials.end());
    all.insert(all.end(), files.textures.begin(), files.textures.end());
    EXPECT_EQ(all, written);
    names.insert(written.begin(), written.end());
    count += written.size();
    bytes.push_back(bytes_to_read_textures(written[0]));
  }
  const std::uint64_t decoding = bytes_needed(read_image_header(folder_ / "a mesh0.png"));
  EXPECT_THAT(bytes, testing::Each(2 * 3 * 32 * 16 + decoding));
  EXPECT_EQ(names.size(), count) << "two formats share the name of a file";
}

TEST_F(TexturedMeshTest, PlyKeepsTheMarksOfUnseenFaces) {
  for (const std::size_t textures : {std::size_t{1}, std::size_t{2}}) {
    TexturedMesh mesh = two_squares(textures);
    mesh.mesh.unseen = {0, 1, 1, 0};
    write_textured_mesh(path_, mesh, TexturedFormat::ply);
    const TexturedMesh again = read_textured_ply(path_);
    EXPECT_EQ(again.mesh.unseen, mesh.mesh.unseen);
    EXPECT_EQ(again.texture_of, mesh.texture_of);
    EXPECT_EQ(again.mesh.faces, mesh.mesh.faces);
  }
}

}  // namespace
}  // namespace axial::io
