// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ply/ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>

#include "base/atomic_file.h"
#include "io/ply/ply_property.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

class PlyTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::empty_folder();
    file_ = folder_ / "cloud.ply";
  }
  void TearDown() override { fs::remove_all(folder_); }

  PointCloud cloud(std::string_view bytes) {
    test::put(file_, bytes);
    return read_cloud_ply(file_);
  }
  Mesh mesh(std::string_view bytes) {
    test::put(file_, bytes);
    return read_mesh_ply(file_);
  }
  std::string error(std::string_view bytes) {
    const std::string message = error_of([&] { cloud(bytes); });
    EXPECT_THAT(message, HasSubstr(file_.string()));
    return message;
  }

  fs::path folder_, file_;
};

PointCloud random_cloud(std::size_t points, bool normals, bool colors, bool views, bool weights) {
  PointCloud cloud;
  if (views) cloud.view_begin.push_back(0);
  const auto scalar = [] { return static_cast<float>(*rc::gen::inRange(-1000000, 1000000)) / 7; };
  for (std::size_t i = 0; i < points; ++i) {
    cloud.positions.emplace_back(scalar(), scalar(), scalar());
    if (normals) cloud.normals.emplace_back(scalar(), scalar(), scalar());
    if (colors) cloud.colors.push_back(*rc::gen::arbitrary<Rgb>());
    if (!views) continue;
    for (int k = *rc::gen::inRange(0, 5); k > 0; --k) {
      cloud.view_images.push_back(*rc::gen::arbitrary<std::uint32_t>());
      if (weights) cloud.view_weights.push_back(scalar());
    }
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  return cloud;
}

RC_GTEST_PROP(Ply, WritesAndReadsBackAnyCloud, ()) {
  const auto points = static_cast<std::size_t>(*rc::gen::inRange(0, 12));
  const auto flag = [] { return *rc::gen::arbitrary<bool>(); };
  const PointCloud cloud = random_cloud(points, flag(), flag(), flag(), flag());
  const fs::path folder = test::empty_folder();
  const fs::path file = folder / "a.ply";
  write_cloud_ply(file, cloud);
  const PointCloud again = read_cloud_ply(file);
  fs::remove_all(folder);
  RC_ASSERT(again.positions == cloud.positions);
  RC_ASSERT(again.normals == cloud.normals);
  RC_ASSERT(again.colors == cloud.colors);
  RC_ASSERT(again.view_begin == cloud.view_begin);
  RC_ASSERT(again.view_images == cloud.view_images);
  RC_ASSERT(again.view_weights == cloud.view_weights);
}

TEST_F(PlyTest, WritesTheLayoutOfOpenMvs) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  cloud.normals = {{0, 0, 1}};
  cloud.colors = {{7, 8, 9}};
  cloud.view_begin = {0, 2};
  cloud.view_images = {5, 6};
  cloud.view_weights = {0.5f, 0.25f};
  write_cloud_ply(file_, cloud);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment AxialMVS" + std::string(19, ' ') +
      "\nelement vertex 1\nproperty float32 x\nproperty float32 y\nproperty float32 z\nproperty "
      "uint8 red\nproperty uint8 green\n"
      "property uint8 blue\nproperty float32 nx\nproperty float32 ny\nproperty float32 nz\n"
      "property list uint8 uint32 view_indices\nproperty list uint8 float32 view_weights\n"
      "end_header\n";
  const std::string bytes = read_file(file_);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  EXPECT_EQ(bytes.size() - header.size(), 12u + 3 + 12 + 9 + 9);
  EXPECT_EQ(bytes[header.size() + 12], 7);  // red follows the position
  write_cloud_ply(file_, cloud, false);
  EXPECT_TRUE(read_cloud_ply(file_).view_begin.empty());
}

TEST_F(PlyTest, RefusesMoreViewsThanAByteCounts) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  cloud.view_begin = {0, 255};
  cloud.view_images.resize(255);
  write_cloud_ply(file_, cloud);
  EXPECT_EQ(read_cloud_ply(file_).views_of(0).size(), 255u);
  cloud.view_begin = {0, 256};
  cloud.view_images.resize(256);
  EXPECT_THAT(error_of([&] { write_cloud_ply(file_, cloud); }), HasSubstr("256 views"));
  cloud.colors.resize(2);
  EXPECT_THAT(error_of([&] { write_cloud_ply(file_, cloud, false); }), HasSubstr("2 colors"));
}

PointCloud three_points() {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  cloud.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  cloud.view_begin = {0, 2, 2, 3};
  cloud.view_images = {5, 6, 9};
  cloud.view_weights = {0.5f, 0.25f, 0.75f};
  return cloud;
}

constexpr CloudLayout kWithColorsAndViews{true, false, true, true};

TEST_F(PlyTest, WritesPortionsAsOneCloud) {
  const PointCloud portion = three_points();
  CloudWriter writer(file_, kWithColorsAndViews);
  for (int i = 0; i < 400; ++i) writer.add(portion);
  EXPECT_EQ(writer.size(), 1200u);
  EXPECT_FALSE(fs::exists(file_));
  writer.finish();
  const PointCloud cloud = read_cloud_ply(file_);
  ASSERT_EQ(cloud.size(), 1200u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(cloud.positions[i], portion.positions[i % 3]);
    ASSERT_EQ(cloud.colors[i], portion.colors[i % 3]);
    ASSERT_TRUE(std::ranges::equal(cloud.views_of(i), portion.views_of(i % 3)));
  }
  EXPECT_TRUE(cloud.normals.empty());
}

TEST_F(PlyTest, WritesErrorsBehindEverythingElse) {
  PointCloud cloud = three_points();
  write_cloud_ply(file_, cloud);
  const std::string plain = read_file(file_);
  cloud.errors = {0.5f, 0.25f, 0};
  cloud.confidences = {1, 0.75f, 0};
  write_cloud_ply(file_, cloud);
  EXPECT_EQ(read_vertex_property(file_, "error"), cloud.errors);
  EXPECT_EQ(read_vertex_property(file_, "confidence"), cloud.confidences);
  EXPECT_EQ(read_file(file_).size(),
            plain.size() + 24 +
                std::string("property float32 error\nproperty float32 confidence\n").size());
  EXPECT_EQ(read_cloud_ply(file_).view_weights, cloud.view_weights);
  cloud.confidences.pop_back();
  EXPECT_THAT(error_of([&] { write_cloud_ply(file_, cloud); }),
              HasSubstr("2 confidences for 3 points"));
}

// Other programs search for the element line, so it has no padding.
TEST_F(PlyTest, PutsTheNumberOfPointsIntoAPlainLine) {
  std::size_t length = 0;
  for (const int portions : {0, 1, 4, 40}) {
    CloudWriter writer(file_, kWithColorsAndViews);
    for (int i = 0; i < portions; ++i) writer.add(three_points());
    writer.finish();
    const std::string bytes = read_file(file_);
    const std::string end = "end_header\n";
    const std::string header = bytes.substr(0, bytes.find(end) + end.size());
    EXPECT_THAT(header, HasSubstr("\nelement vertex " + std::to_string(3 * portions) + "\n"));
    EXPECT_TRUE(
        std::ranges::all_of(header, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    if (portions == 0) length = header.size();
    EXPECT_EQ(header.size(), length);
  }
}

TEST_F(PlyTest, LeavesTheOldCloudUntilTheNewOneIsFinished) {
  write_cloud_ply(file_, three_points());
  const std::string before = read_file(file_);
  {
    CloudWriter writer(file_, kWithColorsAndViews);
    writer.add(three_points());
  }
  EXPECT_EQ(read_file(file_), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(PlyTest, NamesTheCloudThatCannotBeStreamed) {
  const fs::path nowhere = folder_ / "no_such_folder" / "a.ply";
  EXPECT_THAT(error_of([&] { CloudWriter(nowhere, {}); }), HasSubstr(nowhere.string()));
  CloudWriter writer(file_, {true, true, true, true});
  EXPECT_THAT(error_of([&] { writer.add(three_points()); }), HasSubstr("0 normals for 3 points"));
}

const LocalFrame kFar{{534000, 3378500, -12.0625}};

TEST_F(PlyTest, SaysWhereLocalPositionsCountFrom) {
  write_cloud_ply(file_, three_points(), true, {kFar, false});
  EXPECT_THAT(read_file(file_), HasSubstr("\ncomment geo_offset 534000 3378500 -12.0625\n"));
  EXPECT_EQ(read_cloud_ply(file_).positions, three_points().positions);
  EXPECT_EQ(read_cloud_ply(file_, kFar).positions, three_points().positions);
  EXPECT_EQ(read_cloud_ply(file_, {{534000, 3378499, -12.0625}}).positions[0],
            Eigen::Vector3f(1, 3, 3));
  const PlyPlace place = ply_place(file_);
  EXPECT_EQ(place.frame.origin, kFar.origin);
  EXPECT_EQ(place.first_vertex, kFar.origin + Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(place.is_float);
}

TEST_F(PlyTest, ANearCloudHasTheBytesItAlwaysHad) {
  write_cloud_ply(file_, three_points());
  const std::string bytes = read_file(file_);
  EXPECT_EQ(bytes.find("geo_offset"), std::string::npos);
  write_cloud_ply(file_, three_points(), true, {LocalFrame{}, false});
  EXPECT_EQ(read_file(file_), bytes);
}

RC_GTEST_PROP(Ply, DoublesHoldWorldCoordinates, ()) {
  PointCloud cloud;
  const auto scalar = [] { return static_cast<float>(*rc::gen::inRange(-100000, 100000)) * 1e-3f; };
  for (int i = *rc::gen::inRange(1, 12); i > 0; --i)
    cloud.positions.emplace_back(scalar(), scalar(), scalar());
  const fs::path folder = test::empty_folder();
  const fs::path file = folder / "a.ply";
  write_cloud_ply(file, cloud, true, {kFar, true});
  const std::string bytes = read_file(file);
  const auto in_frame = read_cloud_ply(file, kFar).positions;
  const PlyPlace place = ply_place(file);
  write_mesh_ply(file, Mesh{cloud.positions, {}, {{0, 0, 0}}}, {kFar, true});
  const auto of_mesh = read_mesh_ply(file, kFar).vertices;
  fs::remove_all(folder);
  RC_ASSERT(bytes.find("geo_offset") == std::string::npos);
  RC_ASSERT(bytes.find("property float64 x") != std::string::npos);
  RC_ASSERT(of_mesh == in_frame);
  RC_ASSERT(!place.is_float);
  RC_ASSERT(place.first_vertex == kFar.origin + cloud.positions[0].cast<double>());
  // The precision of a double at this distance.
  for (std::size_t i = 0; i < cloud.size(); ++i)
    RC_ASSERT((in_frame[i] - cloud.positions[i]).cwiseAbs().maxCoeff() <= 1e-9f);
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

std::string replaced(std::string_view text, const std::string& from, const std::string& to) {
  std::string result(text);
  const std::size_t at = result.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return result.replace(at, from.size(), to);
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
  write_mesh_ply(file_, mesh(kQuad));
  const std::string mesh_bytes = read_file(file_);
  test::expect_prefixes_refused(file_, mesh_bytes, as_mesh);
  test::expect_damage_survived(file_, mesh_bytes, as_mesh);
  const auto has_faces = [](const fs::path& file) { ply_has_faces(file); };
  test::expect_damage_survived(file_, std::string(kQuad), has_faces);
}

}  // namespace
}  // namespace axial::io
