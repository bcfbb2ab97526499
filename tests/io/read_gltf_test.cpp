// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files as the specification describes them: each kind of Khronos's samples, made small, with
// results that are computed by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/base64.h"
#include "io/gltf_builder.h"
#include "io/images/image.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::GltfBuilder;
using test::kTriangle;
using testing::ElementsAre;
using testing::HasSubstr;
using Face = std::array<std::uint32_t, 3>;
using V = Eigen::Vector3f;

class ReadGltfTest : public test::FolderTest {
 protected:
  fs::path written(const std::string& bytes, const char* name = "m.glb") const {
    write_atomically(folder_ / name, bytes);
    return folder_ / name;
  }
  Mesh shape(GltfBuilder& builder) const { return read_shape(written(builder.glb())); }
  TexturedMesh textured(GltfBuilder& builder) const {
    return read_textured_mesh(written(builder.glb()));
  }
  std::string error(GltfBuilder& builder) const {
    const fs::path file = written(builder.glb());
    return test::error_of([&] { read_textured_mesh(file); });
  }

  // The picture 4 x 2 with a different colour in each pixel, as PNG.
  static cv::Mat3b picture() {
    cv::Mat3b image(2, 4);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 4; ++x)
        image(y, x) = cv::Vec3b(static_cast<uchar>(60 * x), static_cast<uchar>(200 * y), 90);
    return image;
  }
  std::string png() const {
    write_png(folder_ / "p.png", picture());
    std::string bytes = read_file(folder_ / "p.png");
    fs::remove(folder_ / "p.png");
    return bytes;
  }

  // A triangle with the texture coordinates `uv` and a picture in the buffer.
  GltfBuilder with_picture(const std::vector<float>& uv, const json& info = {},
                           const json& sampler = {}) const {
    GltfBuilder builder;
    const json image{{"bufferView", builder.view_of(png())}, {"mimeType", "image/png"}};
    const std::size_t material = builder.material(image, info, sampler);
    builder.mesh({{"POSITION", builder.positions(kTriangle)},
                  {"TEXCOORD_0", builder.uv(uv)}})["material"] = material;
    builder.node({{"mesh", 0}});
    return builder;
  }
};

// u and v of a corner, counted from the upper left corner of the picture of 4 x 2 pixels.
Eigen::Vector2f uv_of(const TexturedMesh& mesh, std::size_t corner) {
  const Eigen::Vector2f pixel = mesh.uv[0][corner];
  const cv::Size size = mesh.textures[mesh.texture_of[0]].size();
  return {(pixel.x() + 0.5f) / static_cast<float>(size.width),
          (pixel.y() + 0.5f) / static_cast<float>(size.height)};
}

void expect_near(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  EXPECT_LT((a - b).norm(), 1e-6) << a.transpose() << ", expected " << b.transpose();
}

TEST_F(ReadGltfTest, DeeplyNestedExtrasAreRefused) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.positions(kTriangle)}});
  builder.node({{"mesh", 0}});
  builder.json["extras"] = "DEEP";
  std::string text = builder.gltf("m.bin");
  const std::string deep = std::string(20000, '[') + std::string(20000, ']');
  text.replace(text.find("\"DEEP\""), 6, deep);
  const fs::path glb = written(GltfBuilder::glb_of(text, builder.buffer), "deep.glb");
  EXPECT_THAT(test::error_of([&] { read_textured_mesh(glb); }),
              HasSubstr("deep.glb: malformed JSON: more than 1000"));
  const fs::path gltf = written(text, "deep.gltf");
  EXPECT_THAT(test::error_of([&] { read_shape(gltf); }),
              HasSubstr("deep.gltf: malformed JSON: more than 1000"));
  for (const auto& read : {+[](const fs::path& file) { is_textured_mesh(file); },
                           +[](const fs::path& file) { bytes_to_read_mesh(file); },
                           +[](const fs::path& file) { mesh_place(file); }})
    EXPECT_THAT(test::error_of([&] { read(gltf); }), HasSubstr("deep.gltf"));
}

TEST_F(ReadGltfTest, UnknownRequiredExtensionsAreNamed) {
  for (const char* name : {"KHR_draco_mesh_compression", "KHR_mesh_quantization",
                           "EXT_meshopt_compression", "KHR_texture_basisu", "XYZ_own"}) {
    GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
    builder.json["extensionsRequired"] = {"KHR_materials_unlit", name};
    EXPECT_THAT(error(builder), HasSubstr(std::string("m.glb: requires the extension ") + name));
  }
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  builder.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  EXPECT_EQ(textured(builder).mesh.faces.size(), 1u);
  GltfBuilder draco;  // used, but not required, without the data that the specification demands
  draco.mesh({{"POSITION", draco.added("accessors", {{"type", "VEC3"},
                                                     {"componentType", 5126},
                                                     {"count", 3}})}})["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
  draco.node({{"mesh", 0}});
  EXPECT_THAT(error(draco), HasSubstr("is compressed by KHR_draco_mesh_compression"));
  builder.json["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  EXPECT_THAT(error(builder), HasSubstr("textures[0] has its picture only in EXT_texture_webp"));
}

// Parent: turns x to y and y to -x, then shifts by (10, 0, 0). Child: twice as large, at (0, 5, 0).
TEST_F(ReadGltfTest, NodesPlaceTheirMeshes) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.positions(kTriangle)}});
  builder.mesh({{"POSITION", builder.positions({7, 7, 7, 8, 8, 8, 9, 9, 9})}});  // unused
  builder.node({{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}, {"children", {1}}});
  builder.added("nodes", {{"mesh", 0}, {"translation", {0, 5, 0}}, {"scale", {2, 2, 2}}});
  builder.node({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  builder.added("nodes", {{"mesh", 1}});
  builder.added("scenes", {{"nodes", {3}}});
  builder.json["scene"] = 0;
  const Mesh mesh = shape(builder);
  EXPECT_THAT(mesh.vertices,
              ElementsAre(V(5, 0, 0), V(5, 2, 0), V(3, 0, 0), V(0, 0, 0), V(1, 0, 0), V(0, 1, 0)));
  EXPECT_THAT(mesh.faces, ElementsAre(Face{0, 1, 2}, Face{3, 4, 5}));
  EXPECT_EQ(mesh_place(folder_ / "m.glb").first_vertex, Eigen::Vector3d(5, 0, 0));
  builder.json["scene"] = 1;
  EXPECT_THAT(shape(builder).vertices, ElementsAre(V(7, 7, 7), V(8, 8, 8), V(9, 9, 9)));
}

// A rotation of 90 degrees about z: (x, y, z, w) = (0, 0, sin 45, cos 45).
TEST_F(ReadGltfTest, RotationsAndMirrorsKeepTheOutside) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  builder.json["nodes"][0]["rotation"] = {0, 0, 0.70710678118654752, 0.70710678118654752};
  const Mesh turned = shape(builder);
  EXPECT_LT((turned.vertices[1] - V(0, 1, 0)).norm(), 1e-6);
  EXPECT_LT((turned.vertices[2] - V(-1, 0, 0)).norm(), 1e-6);
  EXPECT_THAT(turned.faces, ElementsAre(Face{0, 1, 2}));
  builder.json["nodes"][0] = {{"mesh", 0}, {"scale", {-1, 1, 1}}};
  const TexturedMesh mirrored = textured(builder);
  EXPECT_EQ(mirrored.mesh.vertices[1], V(-1, 0, 0));
  EXPECT_THAT(mirrored.mesh.faces, ElementsAre(Face{0, 2, 1}));
  expect_near(uv_of(mirrored, 1), {0, 1});  // with the corner, its texture coordinate
  expect_near(uv_of(mirrored, 2), {1, 0});
}

TEST_F(ReadGltfTest, NodesThatMakeNoTreeAreRefused) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  builder.json["nodes"][0]["children"] = {0};
  EXPECT_THAT(error(builder), HasSubstr("nodes[0] occurs twice"));
  builder.json["nodes"][0]["children"] = {7};
  EXPECT_THAT(error(builder), HasSubstr("nodes[7] does not exist: there are 1"));
  builder.json["nodes"][0] = {{"mesh", 0}, {"matrix", {1, 2, 3}}};
  EXPECT_THAT(error(builder), HasSubstr("nodes[0].matrix is [1,2,3]"));
  builder.json["nodes"][0] = {{"mesh", 0}, {"skin", 0}};
  EXPECT_THAT(error(builder), HasSubstr("nodes[0] has a skin"));
  builder.json["nodes"][0] = {{"mesh", -1}};
  EXPECT_THAT(error(builder), HasSubstr("nodes[0].mesh is -1"));
}

// The product of nodes and primitives, not the size of the file, takes the memory.
TEST_F(ReadGltfTest, ManyNodesWithAMeshOfManyPrimitivesAreRefused) {
  GltfBuilder builder;
  const json primitive = builder.mesh({{"POSITION", builder.positions(kTriangle)}});
  json& primitives = builder.json["meshes"][0]["primitives"];
  for (int i = 0; i < 500; ++i) primitives.push_back(primitive);
  for (int i = 0; i < 500; ++i) builder.node({{"mesh", 0}});
  EXPECT_THAT(error(builder), HasSubstr("nodes[499] exceeds the 250000 primitives"));
}

TEST_F(ReadGltfTest, AccessorsOutsideOfTheirDataAreRefused) {
  const auto error_with = [&](const char* list, const char* key, const json& value) {
    GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
    builder.json[list].back()[key] = value;
    return error(builder);
  };
  EXPECT_THAT(error_with("accessors", "byteOffset", -4), HasSubstr("byteOffset is -4"));
  EXPECT_THAT(error_with("accessors", "byteOffset", 4),
              HasSubstr("ends outside of its buffer view"));
  EXPECT_THAT(error_with("accessors", "count", 4), HasSubstr("ends outside of its buffer view"));
  EXPECT_THAT(error_with("accessors", "count", 4000000000u), HasSubstr("ends outside"));
  EXPECT_THAT(error_with("accessors", "count", 1e300), HasSubstr("count is 1e+300"));
  EXPECT_THAT(error_with("accessors", "componentType", 5122), HasSubstr("componentType 5122"));
  EXPECT_THAT(error_with("accessors", "type", "VEC4"), HasSubstr("has the type VEC4"));
  EXPECT_THAT(error_with("accessors", "bufferView", 99), HasSubstr("bufferViews[99] does not"));
  EXPECT_THAT(error_with("bufferViews", "byteOffset", -8), HasSubstr("byteOffset is -8"));
  EXPECT_THAT(error_with("bufferViews", "byteLength", 1 << 20), HasSubstr("outside of its buffer"));
  EXPECT_THAT(error_with("bufferViews", "byteStride", 4), HasSubstr("byteStride below"));
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.added("accessors", {{"type", "VEC3"},
                                                         {"componentType", 5126},
                                                         {"count", 300000000}})}});
  builder.node({{"mesh", 0}});
  EXPECT_THAT(error(builder), HasSubstr("has 300000000 values, but no bufferView"));
}

TEST_F(ReadGltfTest, TruncatedAndDamagedFilesAreRefused) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  const std::string good = builder.glb();
  const auto read = [](const fs::path& file) { read_textured_mesh(file); };
  test::expect_prefixes_refused(folder_ / "m.glb", good, read);
  test::expect_damage_survived(folder_ / "m.glb", good, read, 20);
}

TEST_F(ReadGltfTest, AllKindsOfIndicesAndPrimitives) {
  const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const auto faces_of = [&](int mode, const json& component, const auto& values) {
    GltfBuilder builder;
    json& primitive = builder.mesh({{"POSITION", builder.positions(square)}});
    primitive["mode"] = mode;
    if (!component.is_null())
      primitive["indices"] =
          builder.accessor(builder.view(values), "SCALAR", component.get<int>(), values.size());
    builder.node({{"mesh", 0}});
    return shape(builder).faces;
  };
  const auto two = ElementsAre(Face{0, 1, 2}, Face{1, 3, 2});
  EXPECT_THAT(faces_of(4, 5121, std::vector<std::uint8_t>{0, 1, 2, 1, 3, 2}), two);
  EXPECT_THAT(faces_of(4, 5123, std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}), two);
  EXPECT_THAT(faces_of(4, 5125, std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}), two);
  // All faces of a strip are seen from the same side.
  EXPECT_THAT(faces_of(5, {}, std::vector<int>{}), ElementsAre(Face{0, 1, 2}, Face{1, 3, 2}));
  EXPECT_THAT(faces_of(5, 5121, std::vector<std::uint8_t>{0, 1, 2, 3, 3}), two);
  EXPECT_THAT(faces_of(6, 5121, std::vector<std::uint8_t>{0, 1, 3, 2}),
              ElementsAre(Face{1, 3, 0}, Face{3, 2, 0}));
  EXPECT_THAT(test::error_of([&] { faces_of(1, {}, std::vector<int>{}); }),
              HasSubstr("the mesh has no faces"));
  EXPECT_THAT(test::error_of([&] {
                faces_of(4, 5121, std::vector<std::uint8_t>{0, 1, 4});
              }),
              HasSubstr("refers to vertex 4, but there are 4"));
  EXPECT_THAT(test::error_of([&] { faces_of(4, {}, std::vector<int>{}); }),
              HasSubstr("no multiple of 3"));
}

TEST_F(ReadGltfTest, SparseAndInterleavedValues) {
  GltfBuilder sparse;
  const std::size_t base = sparse.positions(kTriangle);
  const std::size_t places = sparse.view(std::vector<std::uint16_t>{1, 2});
  const std::size_t values = sparse.view(std::vector<float>{5, 0, 0, 0, 6, 0});
  sparse.json["accessors"][base]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", places}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  sparse.mesh({{"POSITION", base}});
  sparse.node({{"mesh", 0}});
  EXPECT_THAT(shape(sparse).vertices, ElementsAre(V(0, 0, 0), V(5, 0, 0), V(0, 6, 0)));
  sparse.json["accessors"][base].erase("bufferView");  // the base is then zero
  EXPECT_THAT(shape(sparse).vertices, ElementsAre(V(0, 0, 0), V(5, 0, 0), V(0, 6, 0)));
  sparse.json["accessors"][base]["sparse"]["count"] = 4;
  EXPECT_THAT(test::error_of([&] { shape(sparse); }), HasSubstr("replaces more values"));

  // Position, then u and v as 16 bits, 16 bytes a vertex.
  GltfBuilder builder = with_picture({0, 0, 0, 0, 0, 0});
  std::string bytes;
  const std::vector<std::uint16_t> uv{0, 0, 65535, 0, 0, 13107};  // 13107 / 65535 = 0.2
  for (std::size_t i = 0; i < 3; ++i) {
    bytes.append(reinterpret_cast<const char*>(&kTriangle[3 * i]), 12);
    bytes.append(reinterpret_cast<const char*>(&uv[2 * i]), 4);
  }
  const std::size_t view = builder.view_of(bytes, 16);
  json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["POSITION"] = builder.accessor(view, "VEC3", 5126, 3);
  attributes["TEXCOORD_0"] = builder.accessor(view, "VEC2", 5123, 3, 12);
  EXPECT_THAT(error(builder), HasSubstr("integers that are not normalized"));
  builder.json["accessors"].back()["normalized"] = true;
  const TexturedMesh mesh = textured(builder);
  EXPECT_THAT(mesh.mesh.vertices, ElementsAre(V(0, 0, 0), V(1, 0, 0), V(0, 1, 0)));
  expect_near(uv_of(mesh, 1), {1, 0});
  expect_near(uv_of(mesh, 2), {0, 0.2f});
}

// The specification's example: "only the lower left quadrant of the source image, rotated clockwise
// 90 degrees".
TEST_F(ReadGltfTest, TextureTransformsAreApplied) {
  const json transform{{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  GltfBuilder builder =
      with_picture({0, 0, 1, 0, 0, 1}, {{"extensions", {{"KHR_texture_transform", transform}}}});
  const TexturedMesh mesh = textured(builder);
  expect_near(uv_of(mesh, 0), {0, 1});
  expect_near(uv_of(mesh, 1), {0, 0.5f});
  expect_near(uv_of(mesh, 2), {0.5f, 1});
  // Its own set of coordinates comes before that of the texture.
  json& base = builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  base["texCoord"] = 3;
  base["extensions"]["KHR_texture_transform"] = {{"texCoord", 1}, {"scale", {0.5, 1}}};
  builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      builder.uv({0.5, 0.5, 1, 0.5, 0.5, 1});
  expect_near(uv_of(textured(builder), 1), {0.5f, 0.5f});
  base["extensions"] = json::object();
  EXPECT_THAT(error(builder), HasSubstr("has no TEXCOORD_3"));
}

TEST_F(ReadGltfTest, FactorsAndMaterialsWithoutPicture) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  json& look = builder.json["materials"][0]["pbrMetallicRoughness"];
  look["baseColorFactor"] = {1, 0, 0.2158605, 1};
  builder.json["materials"].push_back(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.2158605, 0, 1}}}}});
  json second = builder.json["meshes"][0]["primitives"][0];
  second["material"] = 1;
  builder.json["meshes"][0]["primitives"].push_back(second);
  second.erase("material");
  builder.json["meshes"][0]["primitives"].push_back(second);
  const TexturedMesh mesh = textured(builder);
  ASSERT_EQ(mesh.textures.size(), 3u);
  // Blue 180 is 0.4564 in linear light; times 0.2159 it is 0.0985, which is 0.3467 in sRGB.
  EXPECT_EQ(mesh.textures[0](1, 3), cv::Vec3b(88, 0, 90));
  // 0.2159 in linear light is 128 / 255 in sRGB.
  EXPECT_EQ(mesh.textures[1](0, 0), cv::Vec3b(0, 128, 255));
  EXPECT_EQ(mesh.textures[2](0, 0), cv::Vec3b(255, 255, 255));
  EXPECT_THAT(mesh.texture_of, ElementsAre(0u, 1u, 2u));
  EXPECT_NE(mesh.uv[1][0], mesh.uv[1][1]);  // equal corners would mean that no colour is known
}

TEST_F(ReadGltfTest, WithoutPicturesVerticesHaveColours) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.positions(kTriangle)}});
  builder.node({{"mesh", 0}});
  EXPECT_FALSE(is_textured_mesh(written(builder.glb())));
  EXPECT_TRUE(shape(builder).colors.empty());
  const std::vector<std::uint8_t> colors{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 55, 255};
  const std::size_t accessor = builder.accessor(builder.view(colors), "VEC4", 5121, 3);
  builder.json["accessors"][accessor]["normalized"] = true;
  builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
  // 55 / 255 = 0.2157 in linear light is 0.5019 in sRGB, 128 of 255.
  EXPECT_THAT(shape(builder).colors, ElementsAre(Rgb{255, 0, 0}, Rgb{0, 255, 0}, Rgb{0, 0, 128}));
}

TEST_F(ReadGltfTest, PicturesAndBuffersInAnyPlace) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  const std::string bytes = png();
  const auto expect_picture = [&](const fs::path& file) {
    EXPECT_TRUE(is_textured_mesh(file));
    const TexturedMesh mesh = read_textured_mesh(file);
    ASSERT_EQ(mesh.textures.size(), 1u);
    EXPECT_EQ(cv::norm(mesh.textures[0], picture(), cv::NORM_INF), 0);
    EXPECT_GE(bytes_to_read_textures(file), 24u);
  };
  expect_picture(written(builder.glb()));
  // OpenMVS writes a GLB with its pictures beside it.
  write_atomically(folder_ / "a tree+1.png", bytes);
  builder.json["images"][0] = {{"uri", "a%20tree%2B1.png"}};
  expect_picture(written(builder.glb()));
  EXPECT_THAT(texture_files_of(folder_ / "m.glb").textures, ElementsAre(folder_ / "a tree+1.png"));
  builder.json["images"][0] = {{"uri", "A Tree+1.PNG"}};  // not escaped, in another case
  expect_picture(written(builder.glb()));
  write_atomically(folder_ / "the data.bin", builder.buffer);
  expect_picture(written(builder.gltf("the%20data.bin"), "m.gltf"));
  EXPECT_THAT(files_of_mesh(folder_ / "m.gltf"),
              ElementsAre(folder_ / "m.gltf", folder_ / "the data.bin", folder_ / "a tree+1.png"));
  builder.json["images"][0] = {{"uri", "data:image/png;base64," + base64(bytes)}};
  std::string escaped = base64(builder.buffer);
  for (std::size_t at; (at = escaped.find('=')) != std::string::npos;)
    escaped.replace(at, 1, "%3D");
  expect_picture(
      written(builder.gltf("data:application/octet-stream;base64," + escaped), "e.gltf"));
  EXPECT_THAT(files_of_mesh(folder_ / "e.gltf"), ElementsAre(folder_ / "e.gltf"));
}

TEST_F(ReadGltfTest, PlacesThatAreNotFilesAreRefused) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  const auto error_with = [&](const json& image) {
    builder.json["images"][0] = image;
    return error(builder);
  };
  EXPECT_THAT(error_with({{"uri", "https://a.b/c.png"}}), HasSubstr("images[0] is at https:"));
  EXPECT_THAT(error_with({{"uri", "none.png"}}), HasSubstr("none.png"));
  EXPECT_THAT(error_with({{"uri", "a tree.png%00.jpg"}}),
              HasSubstr("images[0] names a file with a NUL byte"));
  EXPECT_THAT(error_with({{"uri", "data:image/png;base64,A$=="}}), HasSubstr("is not base64"));
  EXPECT_THAT(error_with({{"uri", "data:image/png;base64"}}), HasSubstr("without a comma"));
  EXPECT_THAT(error_with(json::object()), HasSubstr("either a uri or a bufferView"));
  EXPECT_THAT(error_with({{"bufferView", 99}}), HasSubstr("bufferViews[99]"));
  const std::string text = builder.gltf("none.bin");
  const fs::path gltf = written(text, "m.gltf");
  EXPECT_THAT(test::error_of([&] { read_shape(gltf); }), HasSubstr("none.bin"));
}

// The oracle computes the pixel of the picture at each place from the wrapping of one coordinate.
int wrapped(double coordinate, int mode, int pixels) {
  double place = coordinate;
  if (mode == 10497) place = coordinate - std::floor(coordinate);
  if (mode == 33648) {
    place = coordinate - 2 * std::floor(coordinate / 2);
    if (place > 1) place = 2 - place;
  }
  return std::clamp(static_cast<int>(std::floor(place * pixels)), 0, pixels - 1);
}

TEST_F(ReadGltfTest, TexturesRepeatAsTheirSamplerSays) {
  const std::vector<float> uv{-0.7f, 0.3f, 2.2f, 0.3f, -0.7f, -1.6f};
  for (const auto& [s, t] : {std::pair{10497, 33648}, {33648, 10497}, {33071, 33071}}) {
    GltfBuilder builder = with_picture(uv, {}, {{"wrapS", s}, {"wrapT", t}});
    const TexturedMesh mesh = textured(builder);
    for (double a = 0.03; a < 1; a += 0.09)
      for (double b = 0.02; a + b < 1; b += 0.07) {
        const double u = -0.7 + 2.9 * a, v = 0.3 - 1.9 * b;
        const Eigen::Vector2f at = mesh.uv[0][0] +
                                   static_cast<float>(a) * (mesh.uv[0][1] - mesh.uv[0][0]) +
                                   static_cast<float>(b) * (mesh.uv[0][2] - mesh.uv[0][0]);
        const cv::Mat3b& image = mesh.textures[0];
        const int x = std::clamp(static_cast<int>(std::lround(at.x())), 0, image.cols - 1);
        const int y = std::clamp(static_cast<int>(std::lround(at.y())), 0, image.rows - 1);
        EXPECT_EQ(image(y, x), picture()(wrapped(v, t, 2), wrapped(u, s, 4))) << u << " " << v;
      }
  }
  GltfBuilder builder = with_picture({0, 0, 1e6, 0, 0, 1e6});
  EXPECT_THAT(error(builder), HasSubstr("shows its texture 1000000 x 1000000 times"));
}

// A face that lies in another copy of the picture needs no larger texture.
TEST_F(ReadGltfTest, WholeCopiesAreShifted) {
  GltfBuilder builder = with_picture({5, -3, 6, -3, 5, -2});
  const TexturedMesh mesh = textured(builder);
  EXPECT_EQ(mesh.textures[0].size(), cv::Size(4, 2));
  expect_near(uv_of(mesh, 0), {0, 0});
  expect_near(uv_of(mesh, 1), {1, 0});
}

TEST_F(ReadGltfTest, TheMemoryOfAllInstancesIsCounted) {
  GltfBuilder builder;
  std::vector<float> positions(3 * 3000);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i);
  builder.mesh({{"POSITION", builder.positions(positions)}});
  for (int k = 0; k < 50; ++k) builder.node({{"mesh", 0}, {"translation", {k, 0, 0}}});
  const Mesh mesh = shape(builder);
  EXPECT_EQ(mesh.vertices.size(), 150000u);
  EXPECT_GE(bytes_to_read_mesh(folder_ / "m.glb"),
            24 * mesh.vertices.size() + sizeof(V) * mesh.vertices.size() + 12 * mesh.faces.size());
}

TEST_F(ReadGltfTest, OffsetsAndTransformationsAddUp) {
  GltfBuilder builder = with_picture({0, 0, 1, 0, 0, 1});
  builder.json["nodes"][0]["extras"] = {{"geo_offset", {500000, 4e6, -20}}};
  builder.json["nodes"][0]["translation"] = {0.5, 0, 0};
  const fs::path file = written(builder.glb());
  EXPECT_EQ(read_shape(file, LocalFrame{{500000, 4e6, 0}}).vertices[1], V(1.5f, 0, -20));
  EXPECT_EQ(read_textured_mesh(file, LocalFrame{{500000, 4e6, 0}}).mesh.vertices[1],
            V(1.5f, 0, -20));
  EXPECT_EQ(mesh_place(file).first_vertex, Eigen::Vector3d(500000.5, 4e6, -20));
  EXPECT_EQ(read_mesh_of_scene(LocalFrame{{500000, 4e6, 0}}, file).vertices[1], V(1.5f, 0, -20));
}

}  // namespace
}  // namespace axial::io
