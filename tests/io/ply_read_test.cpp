// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/ply/ply.h"
#include "io/ply_fixture.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::replaced;
using testing::HasSubstr;

// Everything that an ascii reader may meet: old and new type names, another order, unknown
// elements, properties and lists, comments, tabs and CRLF.
constexpr std::string_view kForeign =
    "ply\r\nformat ascii 1.0\r\ncomment made elsewhere\r\nobj_info 3\r\n"
    "element camera 1\r\nproperty list uchar int junk\r\nproperty double d\r\n"
    "element vertex 2\r\nproperty uchar diffuse_red\r\nproperty uint8 diffuse_green\r\n"
    "property uchar diffuse_blue\r\nproperty double z\r\nproperty float x\r\n"
    "property float32 y\r\nproperty short quality\r\nproperty list uchar uint view_indices\r\n"
    "element tail 1\r\nproperty list int8 float64 more\r\nend_header\r\n"
    "2 -1 5 1e3\r\n10 20 30 3 1 2 -7 2 4 5\r\n40 50 60 6.5 +4 -5e0 9 0\r\n3 1 2 3\r\n";

TEST_F(PlyTest, FindsPropertiesByName) {
  const PointCloud c = cloud(kForeign);
  ASSERT_EQ(c.size(), 2u);
  EXPECT_EQ(c.positions[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(c.positions[1], Eigen::Vector3f(4, -5, 6.5f));
  EXPECT_EQ(c.colors[1], (Rgb{40, 50, 60}));
  EXPECT_TRUE(c.normals.empty());
  EXPECT_EQ(c.views_of(0).size(), 2u);
  EXPECT_EQ(c.views_of(0)[1], 5u);
  EXPECT_EQ(c.views_of(1).size(), 0u);
  EXPECT_FALSE(ply_has_faces(file_));
}

// The points of a file, read in portions of `points` points.
PointCloud in_portions(const fs::path& file, std::size_t points) {
  PointCloud all;
  all.view_begin.push_back(0);
  read_cloud_portions(file, nullptr, points, [&](const PointCloud& portion, std::size_t count) {
    EXPECT_EQ(portion.size(), std::min(points, count - all.size()));
    all.positions.insert(all.positions.end(), portion.positions.begin(), portion.positions.end());
    for (std::size_t i = 0; i < portion.size(); ++i) {
      for (const std::uint32_t view : portion.views_of(i)) all.view_images.push_back(view);
      all.view_begin.push_back(all.view_images.size());
    }
  });
  return all;
}

TEST_F(PlyTest, PortionsAreTheWholeCloud) {
  // Both files are longer than the buffer of 32 MB, and rows lie across its end.
  constexpr std::uint32_t kPoints = 40000;
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 40000\nproperty float x\nproperty float y\n"
      "property float z\nproperty list uchar uint view_indices\nend_header\n";
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const auto x = static_cast<float>(i);
    cloud.positions.emplace_back(x, -x, 0.5f);
    for (std::uint32_t k = 0; k < 230 + i % 4; ++k) cloud.view_images.push_back(i + k);
    cloud.view_begin.push_back(cloud.view_images.size());
    text += std::to_string(i) + std::string(900, ' ') + "-" + std::to_string(i) + " 0.5 2 1 22\n";
  }
  write_cloud_ply(file_, cloud);
  ASSERT_GT(fs::file_size(file_), 33u << 20);
  const PointCloud read = in_portions(file_, 7001);
  EXPECT_EQ(read.positions, cloud.positions);
  EXPECT_EQ(read.view_images, cloud.view_images);
  EXPECT_EQ(read.view_begin, cloud.view_begin);
  ASSERT_GT(text.size(), 33u << 20);
  test::put(file_, text);
  EXPECT_EQ(in_portions(file_, 30000).positions, cloud.positions);
  EXPECT_EQ(in_portions(file_, 2 * kPoints).views_of(kPoints - 1)[1], 22u);
}

// The bytes of `value` in big-endian order.
template <class T>
std::string big(T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  std::ranges::reverse(bytes);
  return {bytes.begin(), bytes.end()};
}

TEST_F(PlyTest, ReadsBigEndian) {
  const std::string header =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty double y\n"
      "property short z\nproperty list ushort int view_indices\nend_header\n";
  const std::string body = big(1.5f) + big(-2.25) + big(std::int16_t{-300}) +
                           big(std::uint16_t{2}) + big(std::int32_t{70000}) + big(std::int32_t{1});
  const PointCloud c = cloud(header + body);
  EXPECT_EQ(c.positions[0], Eigen::Vector3f(1.5f, -2.25f, -300));
  EXPECT_EQ(c.views_of(0)[0], 70000u);
}

constexpr std::string_view kQuad =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_index\n"
    "property list uchar float texcoord\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 2 0.5 0.5\n3 0 1 2 0\n";

TEST_F(PlyTest, SplitsPolygonsIntoFans) {
  const Mesh m = mesh(kQuad);
  ASSERT_EQ(m.faces.size(), 3u);
  EXPECT_EQ(m.faces[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(m.faces[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_TRUE(ply_has_faces(file_));
}

TEST_F(PlyTest, WritesAndReadsBackAMesh) {
  Mesh m = mesh(kQuad);
  m.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  write_mesh_ply(file_, m);
  const Mesh again = read_mesh_ply(file_);
  EXPECT_EQ(again.vertices, m.vertices);
  EXPECT_EQ(again.colors, m.colors);
  EXPECT_EQ(again.faces, m.faces);
}

// All triangles of a marked polygon are marked, and any number but 0 is a mark.
TEST_F(PlyTest, MarksOfUnseenFacesAreReadAndWritten) {
  const Mesh m = mesh(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty int unseen\n"
      "property list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 4 0 1 2 3\n0 3 0 1 2\n1 3 2 1 0\n");
  EXPECT_EQ(m.unseen, (std::vector<std::uint8_t>{1, 1, 0, 1}));
  write_mesh_ply(file_, m);
  EXPECT_EQ(read_mesh_ply(file_).unseen, m.unseen);
  EXPECT_EQ(read_mesh_ply(file_).faces, m.faces);
  EXPECT_TRUE(mesh(kQuad).unseen.empty());
  Mesh wrong = m;
  wrong.unseen.pop_back();
  EXPECT_THAT(error_of([&] { write_mesh_ply(file_, wrong); }), HasSubstr("marks of faces"));
}

TEST_F(PlyTest, NamesWhatIsWrongInAMesh) {
  const auto message = [&](const std::string& from, const std::string& to) {
    return error_of([&] { mesh(replaced(kQuad, from, to)); });
  };
  EXPECT_THAT(message("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("vertex 4"));
  EXPECT_THAT(message("4 0 1 2 3", "4 0 1 2 -1"), HasSubstr("-1"));
  EXPECT_THAT(message("3 0 1 2 0", "2 0 1 0"), HasSubstr("2 corners"));
  EXPECT_THAT(message("4 0 1 2 3", "255 0 1 2 3"), HasSubstr("vertex_index"));
  EXPECT_THAT(message("vertex_index", "corners"), HasSubstr("vertex_indices"));
  EXPECT_THAT(message("element face 2", "element edge 2"), HasSubstr("not a mesh"));
}

TEST_F(PlyTest, NamesWhatIsWrongInAHeader) {
  const std::string good =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  EXPECT_EQ(cloud(good).size(), 1u);
  const auto message = [&](const std::string& from, const std::string& to) {
    return error(replaced(good, from, to));
  };
  EXPECT_THAT(message("ply\n", "plx\n"), HasSubstr("not a PLY file"));
  EXPECT_THAT(message("ascii", "utf8"), HasSubstr("utf8"));
  EXPECT_THAT(message("1.0", "2.0"), HasSubstr("2.0"));
  EXPECT_THAT(message("format ascii 1.0\n", ""), HasSubstr("format"));
  EXPECT_THAT(message("element vertex 1\n", ""), HasSubstr("before any element"));
  EXPECT_THAT(message("vertex 1", "vertex -1"), HasSubstr("'-1'"));
  EXPECT_THAT(message("vertex 1", "vertex 18446744073709551615"), HasSubstr("truncated"));
  EXPECT_THAT(message("vertex 1", "vertex 2"), HasSubstr("truncated"));
  EXPECT_THAT(message("vertex 1", "edge 1"), HasSubstr("no element vertex"));
  EXPECT_THAT(message("float y", "real y"), HasSubstr("real"));
  EXPECT_THAT(message("float y", "float x"), HasSubstr("declared twice"));
  EXPECT_THAT(message("property float y\n", ""), HasSubstr("has no x, y or z"));
  EXPECT_THAT(message("float y", "list float int y"), HasSubstr("counted in a float"));
  EXPECT_THAT(message("property float z", "property float z junk"), HasSubstr("junk"));
  EXPECT_THAT(message("end_header", "end_head"), HasSubstr("end_head"));
  EXPECT_THAT(message("1 2 3", "1 2 3 4"), HasSubstr("follow the last element"));
  EXPECT_THAT(message("1 2 3", "1 two 3"), HasSubstr("two"));
  EXPECT_THAT(message("1 2 3", "1 nan 3"), HasSubstr("not finite"));
  EXPECT_THAT(message("1 2 3", "1 1e300 3"), HasSubstr("not finite"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 99999999999999\nend_header\n"),
              HasSubstr("without properties"));
}

TEST_F(PlyTest, NamesAWrongOffset) {
  const auto with_comment = [](const std::string& comment) {
    return "ply\nformat ascii 1.0\n" + comment +
           "\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
           "end_header\n1 2 3\n";
  };
  EXPECT_THAT(error(with_comment("comment geo_offset 1 2")), HasSubstr("line 3: geo_offset"));
  EXPECT_THAT(error(with_comment("comment geo_offset 1 2 x")), HasSubstr("'x'"));
  EXPECT_THAT(error(with_comment("comment geo_offset 1 2 nan")), HasSubstr("'nan'"));
  EXPECT_THAT(error(with_comment("comment geo_offset 1 2 3 4")), HasSubstr("unexpected '4'"));
  EXPECT_THAT(error(with_comment("comment geo_offset 1 2 3\ncomment geo_offset 1 2 3")),
              HasSubstr("second geo_offset"));
  EXPECT_EQ(cloud(with_comment("comment\ncomment my geo_offset 1")).size(), 1u);
}

TEST_F(PlyTest, ChecksTheRangeOfIntegers) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property list uchar uint view_indices\nproperty list uchar float view_weights\nend_header\n";
  EXPECT_EQ(cloud(header + "0 0 0 255 0 1 1 4294967295 1 0.5\n").view_images[0], 4294967295u);
  EXPECT_THAT(error(header + "0 0 0 256 0 1 1 7 1 0.5\n"), HasSubstr("256"));
  EXPECT_THAT(error(header + "0 0 0 1.5 0 1 1 7 1 0.5\n"), HasSubstr("1.5"));
  EXPECT_THAT(error(header + "0 0 0 1 0 1 1 4294967296 1 0.5\n"), HasSubstr("4294967296"));
  EXPECT_THAT(error(header + "0 0 0 1 0 1 1 7 0\n"), HasSubstr("view_weights"));
  EXPECT_THAT(error(header + "0 0 0 1 0 1 200 7 0\n"), HasSubstr("view_indices"));
}

TEST_F(PlyTest, SurvivesWrongInput) {
  const auto as_cloud = [](const fs::path& file) { read_cloud_ply(file); };
  const auto as_mesh = [](const fs::path& file) { read_mesh_ply(file); };
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.view_begin = {0, 1, 3};
  cloud.view_images = {1, 2, 3};
  cloud.view_weights = {1, 2, 3};
  write_cloud_ply(file_, cloud);
  const std::string binary = read_file(file_);
  test::expect_prefixes_refused(file_, binary, as_cloud);
  test::expect_damage_survived(file_, binary, as_cloud);
  test::expect_prefixes_refused(file_, kForeign, as_cloud);
  test::expect_damage_survived(file_, std::string(kForeign), as_cloud);
  test::expect_prefixes_refused(file_, kQuad, as_mesh);
  test::expect_damage_survived(file_, std::string(kQuad), as_mesh);
  const auto in_parts = [](const fs::path& file) {
    read_cloud_portions(file, nullptr, 1, [](const PointCloud&, std::size_t) {});
  };
  test::expect_prefixes_refused(file_, binary, in_parts);
  test::expect_damage_survived(file_, binary, in_parts);
  test::expect_damage_survived(file_, std::string(kForeign), in_parts);
  const auto place = [](const fs::path& file) { ply_place(file); };
  test::expect_damage_survived(file_, binary, place);
  write_mesh_ply(file_, mesh(kQuad));
  const std::string mesh_bytes = read_file(file_);
  test::expect_prefixes_refused(file_, mesh_bytes, as_mesh);
  test::expect_damage_survived(file_, mesh_bytes, as_mesh);
  const auto has_faces = [](const fs::path& file) { ply_has_faces(file); };
  test::expect_damage_survived(file_, std::string(kQuad), has_faces);
}

const Mesh kOneFace{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};

TEST_F(PlyTest, VertexPropertiesGoThroughAFileAndLeaveTheMeshAsItIs) {
  const std::vector<float> values{0.5f, 0.0f, 7.25f};
  write_mesh_ply(file_, kOneFace, VertexProperty{"thickness", values});
  EXPECT_EQ(read_vertex_property(file_, "thickness"), values);
  EXPECT_TRUE(read_vertex_property(file_, "error").empty());
  const Mesh again = read_mesh_ply(file_);
  EXPECT_EQ(again.vertices, kOneFace.vertices);
  EXPECT_EQ(again.faces, kOneFace.faces);
  EXPECT_THROW(write_mesh_ply(file_, kOneFace, VertexProperty{"thickness", {}}), Error);
}

TEST_F(PlyTest, VertexPropertiesAreFoundBehindListsAndOtherElementsAndInText) {
  write_atomically(
      file_,
      "ply\nformat ascii 1.0\nelement other 1\nproperty float error\nelement vertex 2\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property list uchar uint view_indices\nproperty float error\n"
      "end_header\n9\n0 0 0 2 4 5 0.25\n1 1 1 0 0.5\n");
  EXPECT_EQ(read_vertex_property(file_, "error"), (std::vector<float>{0.25f, 0.5f}));
  EXPECT_TRUE(read_vertex_property(file_, "view_indices").empty()) << "a list";
}

TEST_F(PlyTest, VertexPropertiesOfATruncatedFileAreAnError) {
  write_mesh_ply(file_, kOneFace, VertexProperty{"thickness", std::vector<float>{1, 2, 3}});
  const std::string bytes = read_file(file_);
  write_atomically(file_, bytes.substr(0, bytes.find("end_header\n") + 11 + 20));
  EXPECT_THROW(read_vertex_property(file_, "thickness"), Error);
}

}  // namespace
}  // namespace axial::io
