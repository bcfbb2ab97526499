// SPDX-License-Identifier: GPL-3.0-or-later
// PLY clouds and meshes, and textured meshes.
#include "io/ply/ply.h"

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>

#include "base/base64.h"
#include "io/frames/ply_transform.h"
#include "io/gltf_builder.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

// The format that the writer uses counts the views of a point in a byte.
bool can_be_written(const PointCloud& cloud) {
  for (std::size_t i = 0; !cloud.view_begin.empty() && i < cloud.size(); ++i)
    if (cloud.views_of(i).size() > 255) return false;
  return true;
}

PointCloud read_cloud(const fs::path& file) {
  return io::read_cloud_ply(file);
}

void read_cloud_file(const fs::path& file) {
  const PointCloud cloud = read_cloud(file);
  if (!can_be_written(cloud)) return;
  const PointCloud again = read_copy(
      cloud, file, read_cloud,
      [](const fs::path& path, const PointCloud& value) { io::write_cloud_ply(path, value); });
  require(again.positions == cloud.positions, "the copy has other positions");
  require(again.normals == cloud.normals, "the copy has other normals");
  require(again.colors == cloud.colors, "the copy has other colours");
  require(again.view_images == cloud.view_images, "the copy has other views");
}

void read_mesh_file(const fs::path& file) {
  const auto read = [](const fs::path& path) { return io::read_mesh_ply(path); };
  const Mesh mesh = read(file);
  const Mesh again = read_copy(mesh, file, read, [](const fs::path& path, const Mesh& value) {
    io::write_mesh_ply(path, value);
  });
  require(again.vertices == mesh.vertices, "the copy has other vertices");
  require(again.colors == mesh.colors, "the copy has other colours");
  require(again.faces == mesh.faces, "the copy has other faces");
}

TexturedMesh small_textured(std::size_t textures) {
  TexturedMesh mesh;
  mesh.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 1}}};
  mesh.uv = {{{{1, 1}, {3, 1}, {1, 3}}}, {{{1, 1}, {1, 3}, {3, 1}}}};
  mesh.texture_of = {0, textures > 1 ? 1u : 0u};
  mesh.textures.assign(textures, cv::Mat3b(4, 8, cv::Vec3b(1, 2, 3)));
  return mesh;
}

// What programs ask of a mesh before they read it.
void ask_of_mesh(const fs::path& file) {
  io::mesh_place(file);
  io::bytes_to_read_mesh(file);
  io::texture_files_of(file);
  io::read_shape(file, LocalFrame{{1e6, -2e6, 3}});
  if (io::is_textured_mesh(file)) io::bytes_to_read_textures(file);
}

// The textures are beside the file. Texture coordinates are rounded when they are written and read.
void read_textured_file(const fs::path& file) {
  const cv::Mat3b texture(4, 8, cv::Vec3b(1, 2, 3));
  for (const char* name : {"mesh0.png", "mesh1.png"})
    if (!fs::exists(file.parent_path() / name))
      io::write_textured_mesh(file.parent_path() / "mesh.ply", {{}, {}, {}, {texture, texture}},
                              io::TexturedFormat::ply);
  ask_of_mesh(file);
  const auto read = [](const fs::path& path) { return io::read_textured_ply(path); };
  const TexturedMesh mesh = read(file);
  const TexturedMesh again =
      read_copy(mesh, file, read, [](const fs::path& path, const TexturedMesh& value) {
        io::write_textured_mesh(path, value, io::TexturedFormat::ply);
      });
  require(again.mesh.vertices == mesh.mesh.vertices, "the copy has other vertices");
  require(again.mesh.faces == mesh.mesh.faces, "the copy has other faces");
  require(again.texture_of == mesh.texture_of, "the copy has other texture numbers");
}

// A GLB with any extension.
void write_glb(const fs::path& path, const TexturedMesh& mesh) {
  io::write_textured_mesh(path, mesh, io::TexturedFormat::glb);
  const fs::path written = fs::path(path).replace_extension(".glb");
  if (written != path) fs::rename(written, path);
}

// The copy has its own order of vertices and faces. Large textures, with copies of a picture, are
// not copied, because that takes too long.
void read_glb_file(const fs::path& file) {
  ask_of_mesh(file);
  const auto read = [](const fs::path& path) {
    return io::read_textured_gltf(path, {}, dropping_lines());
  };
  const TexturedMesh mesh = read(file);
  for (const cv::Mat3b& texture : mesh.textures)
    if (texture.total() > (1u << 16)) return;
  const TexturedMesh again =
      read_copy(mesh, file, read,
                [](const fs::path& path, const TexturedMesh& value) { write_glb(path, value); });
  require(again.mesh.faces.size() == mesh.mesh.faces.size(), "the copy has other faces");
}

// The materials and textures are beside the file.
void read_obj_file(const fs::path& file) {
  const fs::path materials = file.parent_path() / "mesh.mtl";
  if (!fs::exists(materials)) {
    io::write_textured_mesh(file.parent_path() / "other.obj", small_textured(2),
                            io::TexturedFormat::obj);
    fs::rename(file.parent_path() / "other.mtl", materials);
  }
  ask_of_mesh(file);
  io::read_textured_obj(file);
}

// An OBJ that uses the first material of the file.
void read_mtl_file(const fs::path& file) {
  io::write_textured_mesh(file.parent_path() / "other.ply", small_textured(1),
                          io::TexturedFormat::ply);
  const fs::path obj = file.parent_path() / "mesh.obj";
  write_atomically(obj,
                   "mtllib mesh.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 2 0\n"
                   "vt 0 1\nf 1/1 2/2 3/3\n");
  io::read_textured_obj(obj);
}

bool write_mtl_seed(const fs::path& file, int variant) {
  constexpr std::array kSeeds{
      "newmtl a\nKd 0.5 0.5 1\nmap_Kd other0.png\n",
      "# made by hand\r\nnewmtl a\r\nmap_Kd -s 2 0.5 -o 0.25 0 0 \\\r\n -clamp on OTHER0.PNG\r\n",
      "newmtl a\nKd 1\nnewmtl b\nmap_kd -bm 1 -mm 0 1 -blendu off .\\textures\\other0.png\n"};
  const auto seed = static_cast<std::size_t>(variant);
  if (seed < kSeeds.size()) write_atomically(file, kSeeds[seed]);
  return seed < kSeeds.size();
}

// Features that the program's own files do not have.
bool write_obj_seed(const fs::path& file, int variant) {
  if (variant < 2) {
    io::write_textured_mesh(file, small_textured(static_cast<std::size_t>(variant + 1)),
                            io::TexturedFormat::obj);
    return true;
  }
  write_atomically(
      file,
      "# geo_offset 500000 4e6 2\nusemtl material_0\nf -3/-3/1 -2/-2/1 -1/-1/1\n"
      "mtllib mesh.mtl\nv 0 0 0 1 0.5 0\nv 1 0 0 0 0 1\nv 0 1 0 0 1 0\nvt 0.5\n"
      "vt 1 1 0\nvt 2 -1\nvn 0 0 1\ng part\nf 1/1 2/2 \\\n 3/3 # end\nusemtl\nf 1 2 3\n");
  return variant < 3;
}

// Nodes with transformations, a strip, colours, a sparse accessor, a moved texture in a data URI.
test::GltfBuilder varied_gltf() {
  test::GltfBuilder builder;
  nlohmann::json& primitive = builder.mesh({{"POSITION", builder.positions(test::kTriangle)},
                                            {"TEXCOORD_0", builder.uv({0, 0, 2, 0, 0, 1})}});
  primitive["mode"] = 5;
  primitive["indices"] = builder.indices({0, 1, 2});
  const std::size_t places = builder.view(std::vector<std::uint16_t>{1});
  const std::size_t values = builder.view(std::vector<float>{5, 0, 0});
  builder.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", places}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  builder.node({{"children", {1}}, {"translation", {1, 0, 0}}, {"rotation", {0, 0, 1, 0}}});
  builder.added("nodes",
                {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"extras", {{"geo_offset", {1, 2, 3}}}}});
  return builder;
}

bool write_glb_seed(const fs::path& file, int variant) {
  if (variant < 2) {
    write_glb(file, small_textured(static_cast<std::size_t>(variant + 1)));
    return true;
  }
  test::GltfBuilder builder = varied_gltf();
  std::vector<unsigned char> png;
  cv::imencode(".png", cv::Mat3b(2, 2, cv::Vec3b(1, 2, 3)), png);
  const std::string bytes(png.begin(), png.end());
  const nlohmann::json transform{{"offset", {0.5, 0}}, {"rotation", 0.5}, {"scale", {2, 1}}};
  builder.material({{"uri", "data:image/png;base64," + base64(bytes)}},
                   {{"extensions", {{"KHR_texture_transform", transform}}}}, {{"wrapS", 33648}});
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  if (variant == 2) write_atomically(file, builder.glb());
  // The reader tells a .gltf by its content.
  if (variant == 3) write_atomically(file, builder.gltf("data:;base64," + base64(builder.buffer)));
  return variant < 4;
}

// Functions that read only a part of a file.
void read_parts(const fs::path& file) {
  io::count_point_cloud(file, {});
  io::ply_has_faces(file);
  io::read_vertex_property(file, "confidence");
  io::ply_place(file);
  io::read_cloud_ply(file, LocalFrame{{1e6, -2e6, 3}});
}

// The result is a file of the same vertices, which can be read again.
void move_file(const fs::path& file) {
  const PointCloud before = io::read_cloud_ply(file);
  const FrameMove move{{2, Eigen::Matrix3d::Identity(), {1, 2, 3}}, {}, LocalFrame{{10, 0, 0}}};
  const fs::path moved = file.parent_path() / "moved.ply";
  io::transform_ply(file, moved, move);
  require(io::read_cloud_ply(moved).size() == before.size(), "the moved file has other vertices");
}

PointCloud small_cloud() {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.normals = {{0, 0, 1}, {0, 1, 0}};
  cloud.colors = {{1, 2, 3}, {4, 5, 6}};
  cloud.view_begin = {0, 2, 3};
  cloud.view_images = {0, 2, 1};
  cloud.view_weights = {0.5f, 0.25f, 1};
  cloud.errors = {0.1f, 0.2f};
  cloud.confidences = {0.5f, 1};
  return cloud;
}

constexpr const char* kAscii =
    "ply\nformat ascii 1.0\ncomment geo_offset 500000 -4e6 2\nobj_info none\nelement vertex 3\n"
    "property float64 x\nproperty double y\nproperty float z\nproperty uchar diffuse_red\n"
    "property uchar diffuse_green\nproperty uchar diffuse_blue\nelement other 1\n"
    "property list short int16 values\nelement face 1\nproperty list uchar int vertex_index\n"
    "end_header\n0 0 1 9 8 7\n1.5 0 1e-3 6 5 4\n0 1 0 3 2 1\n2 -5 7\n3 0 1 2\n";

std::string big_endian() {
  using namespace std::string_literals;
  return "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 1\r\nproperty ushort x\r\n"
         "property uint y\r\nproperty int8 z\r\nproperty list ushort uint view_indices\r\n"
         "end_header\r\n\0\5\0\0\0\7\xFE\0\1\0\0\0\3"s;
}

bool write_cloud_seed(const fs::path& file, int variant) {
  const io::PlyPlacement placement{LocalFrame{{500000, 4e6, 0}}, variant == 1};
  if (variant < 2) io::write_cloud_ply(file, small_cloud(), true, placement);
  if (variant == 2) write_atomically(file, kAscii);
  if (variant == 3) write_atomically(file, big_endian());
  return variant < 4;
}

bool write_mesh_seed(const fs::path& file, int variant) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};
  if (variant == 1) mesh.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  io::write_mesh_ply(file, mesh);
  if (variant == 2) write_atomically(file, kAscii);
  return variant < 3;
}

constexpr const char* kTexturedVertices =
    "ply\nformat ascii 1.0\ncomment TextureFile mesh0.png\ncomment TextureFile mesh1.png\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n"
    "property float t\nproperty int texnumber\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 1 0 0 1\n1 0 1 1 0 1\n"
    "1 1 1 1 1 1\n0 1 1 0 1 0\n4 0 1 2 3\n";

bool write_textured_seed(const fs::path& file, int variant) {
  const auto textures = static_cast<std::size_t>(variant + 1);
  if (variant < 2) io::write_textured_mesh(file, small_textured(textures), io::TexturedFormat::ply);
  if (variant == 2) write_atomically(file, kTexturedVertices);
  return variant < 3;
}

}  // namespace

std::span<const Reader> ply_readers() {
  static constexpr std::array kReaders{
      Reader{"ply-cloud", "cloud.ply", read_cloud_file, write_cloud_seed},
      Reader{"ply-mesh", "mesh.ply", read_mesh_file, write_mesh_seed},
      Reader{"ply-parts", "cloud.ply", read_parts, write_cloud_seed},
      Reader{"ply-moved", "cloud.ply", move_file, write_cloud_seed},
      Reader{"ply-textured", "mesh.ply", read_textured_file, write_textured_seed},
      Reader{"textured-glb", "mesh.glb", read_glb_file, write_glb_seed},
      Reader{"textured-gltf", "mesh.gltf", read_glb_file, write_glb_seed},
      Reader{"textured-mtl", "mesh.mtl", read_mtl_file, write_mtl_seed},
      Reader{"textured-obj", "mesh.obj", read_obj_file, write_obj_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
