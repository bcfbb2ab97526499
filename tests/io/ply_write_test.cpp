// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "io/ply/ply.h"
#include "io/ply_fixture.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

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

TEST_F(PlyTest, AppendsTheBytesOfOtherClouds) {
  const fs::path part = folder_ / "part.ply", empty = folder_ / "empty.ply";
  const PlyPlacement world{{{534000, 3378500, -12.0625}}, true};
  for (const int portions : {0, 2}) {
    CloudWriter writer(portions == 0 ? empty : part, kWithColorsAndViews, world);
    for (int i = 0; i < portions; ++i) writer.add(three_points());
    writer.finish();
  }
  CloudWriter expected(file_, kWithColorsAndViews, world);
  for (int i = 0; i < 5; ++i) expected.add(three_points());
  expected.finish();
  const std::string bytes = read_file(file_);
  CloudWriter writer(file_, kWithColorsAndViews, world);
  writer.add_file(part, 6);
  writer.add(three_points());
  writer.add_file(empty, 0);
  writer.add_file(part, 6);
  EXPECT_EQ(writer.size(), 15u);
  writer.finish();
  EXPECT_EQ(read_file(file_), bytes);
}

TEST_F(PlyTest, RefusesToAppendCloudsOfOtherKinds) {
  const fs::path part = folder_ / "part.ply";
  write_cloud_ply(part, three_points());
  const auto refusal = [&](const CloudLayout& layout, const fs::path& added, std::size_t points) {
    CloudWriter writer(file_, layout);
    return error_of([&] { writer.add_file(added, points); });
  };
  CloudWriter(file_, kWithColorsAndViews).add_file(part, 3);
  EXPECT_THAT(refusal(kWithColorsAndViews, part, 4), HasSubstr("part.ply: is not a cloud of 4"));
  EXPECT_THAT(refusal({true, false, true, false}, part, 3), HasSubstr("part.ply: is not a cloud"));
  EXPECT_THAT(refusal(kWithColorsAndViews, folder_ / "none.ply", 3), HasSubstr("none.ply"));
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

}  // namespace
}  // namespace axial::io
