// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "io/mvs_bytes.h"
#include "io/openmvs/mvs.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_F(MvsTest, ReadsEveryVersion) {
  for (unsigned version = 0; version <= 7; ++version) {
    SCOPED_TRACE(version);
    Description d;
    d.version = version;
    if (version == 0) d.k = {500 / 640.0, 0, 0.5, 0, 510 / 640.0, 0.375, 0, 0, 1};
    const Scene scene = read(d);
    ASSERT_EQ(scene.images.size(), 3u);
    const SceneImage& a = scene.images[0];
    EXPECT_EQ(a.path, (folder_ / "images/a.png").string());
    EXPECT_EQ(a.mask_path, version >= 5 ? (folder_ / "masks/a.png").string() : "");
    EXPECT_EQ(a.id, version >= 3 ? 40u : 0u);
    EXPECT_EQ(scene.images[2].id, 2u);  // no id: the index is used
    EXPECT_TRUE(a.calibrated);
    EXPECT_FALSE(scene.images[2].calibrated);
    EXPECT_EQ(a.camera.width, 640);
    EXPECT_EQ(a.camera.height, 480);
    EXPECT_FALSE(a.camera.port);
    EXPECT_DOUBLE_EQ(a.camera.lens.fx, 500);
    EXPECT_DOUBLE_EQ(a.camera.lens.fy, 510);
    EXPECT_DOUBLE_EQ(a.camera.lens.cx, 320);
    EXPECT_DOUBLE_EQ(a.camera.lens.cy, 240);
    EXPECT_EQ(a.pose.rotation.row(0), Eigen::RowVector3d(0, 1, 0));
    EXPECT_EQ(a.pose.centre, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(a.average_depth, version >= 7 ? 2.0f : 0.0f);
    ASSERT_EQ(a.neighbours.size(), version >= 7 ? 1u : 0u);
    if (version >= 7) {
      EXPECT_EQ(a.neighbours[0].points, 12u);
      EXPECT_EQ(a.neighbours[0].angle, 0.25f);
    }
    ASSERT_EQ(scene.points.size(), 2u);
    ASSERT_EQ(scene.points[0].views.size(), 3u);
    EXPECT_EQ(scene.points[0].views[0].image, 0u);
    EXPECT_EQ(scene.points[0].views[2].image, 1u);
    EXPECT_EQ(scene.point_normals[1], Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(scene.point_colors[0], (Rgb{3, 2, 1}));
    EXPECT_FALSE(scene.region);
  }
}

TEST_F(MvsTest, ResolvesBothNormalisedConventions) {
  Description d;
  d.version = 3;
  d.width = d.height = 0;
  // Relative to the image centre: c_n = (c_px + 0.5) / S - 0.5.
  d.k = {500 / 640.0, 0, 320.5 / 640 - 0.5, 0, 510 / 640.0, 240.5 / 640 - 0.5, 0, 0, 1};
  EXPECT_NEAR(read(d).images[0].camera.lens.cx, 320, 1e-9);
  EXPECT_NEAR(read(d).images[0].camera.lens.cy, 240, 1e-9);
  EXPECT_NEAR(read(d).images[0].camera.lens.fx, 500, 1e-9);
  // Relative to the image corner: c_n = c_px / S.
  d.k[2] = 310 / 640.0;
  d.k[5] = 230 / 640.0;
  EXPECT_NEAR(read(d).images[0].camera.lens.cx, 310, 1e-9);
  EXPECT_NEAR(read(d).images[0].camera.lens.cy, 230, 1e-9);
  // Both are zero: the image centre.
  d.k[2] = d.k[5] = 0;
  EXPECT_EQ(read(d).images[0].camera.lens.cx, 319.5);
  EXPECT_EQ(read(d).images[0].camera.lens.cy, 239.5);
  // There is no file from which to read the resolution.
  fs::remove(folder_ / "images/b.png");
  EXPECT_THAT(error_of([&] { read(d); }), HasSubstr("b.png"));
}

TEST_F(MvsTest, ComposesCameraOnPlatform) {
  Description d;
  d.camera_r = {1, 0, 0, 0, 0, 1, 0, -1, 0};
  d.camera_c = {0.1, 0.2, 0.3};
  const Pose pose = read(d).images[0].pose;
  // Independent check: a point is transformed to the platform's frame, then to the camera's.
  const Eigen::Vector3d x(4, -5, 6);
  Eigen::Matrix3d r_pose, r_cam;
  r_pose << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  r_cam << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Eigen::Vector3d on_platform = r_pose * (x - Eigen::Vector3d(1, 2, 3));
  const Eigen::Vector3d in_camera = r_cam * (on_platform - Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_LT((pose.to_camera(x) - in_camera).norm(), 1e-14);
}

TEST_F(MvsTest, ReadsTheRegionAsOpenMvsUsesIt) {
  Description d;
  d.box_r = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  d.box_min = {9, 18, 27};
  d.box_max = {11, 22, 33};
  const auto region = read(d).region;
  ASSERT_TRUE(region);
  EXPECT_EQ(region->centre, Eigen::Vector3d(10, 20, 30));  // a point in the world
  EXPECT_EQ(region->half_extent, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(region->contains({11.9, 20, 30}));  // the y axis of the box is the world's -x axis
  EXPECT_FALSE(region->contains({10, 21.9, 30}));
  EXPECT_THAT(error([](Description& e) {
                e.box_max = {1, 1, 1};
                e.box_r[0] = 2;
              }),
              HasSubstr("obb"));
}

TEST_F(MvsTest, MakesRoundedRotationsOrthonormal) {
  Description d;
  const Eigen::Matrix3f r = Eigen::AngleAxisf(1.0f, Eigen::Vector3f(1, 2, 3).normalized()).matrix();
  for (std::size_t i = 0; i < 9; ++i)
    d.pose_r[i] = static_cast<double>(
        std::round(r(static_cast<int>(i / 3), static_cast<int>(i % 3)) * 1e5f) * 1e-5f);
  const Eigen::Matrix3d read_r = read(d).images[0].pose.rotation;
  EXPECT_LT((read_r * read_r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((read_r - r.cast<double>()).norm(), 3e-5);  // the values above have 5 digits
}

TEST_F(MvsTest, NamesWhatIsWrong) {
  using D = Description;
  EXPECT_THAT(error([](D& d) { d.version = 8; }), HasSubstr("version is 8"));
  EXPECT_THAT(error([](D& d) { d.k[0] = 0; }), HasSubstr("images[0] K"));
  EXPECT_THAT(error([](D& d) { d.k[4] = -1; }), HasSubstr("-1"));
  EXPECT_THAT(error([](D& d) { d.k[1] = 0.5; }), HasSubstr("skew 0.5"));
  EXPECT_THAT(error([](D& d) { d.k[2] = kNan; }), HasSubstr("not finite"));
  EXPECT_THAT(error([](D& d) { d.k[8] = 2; }), HasSubstr("calibration matrix"));
  EXPECT_THAT(error([](D& d) { d.width = 0; }), HasSubstr("0x480"));
  EXPECT_THAT(error([](D& d) { d.height = 0xFFFFFFFFu; }), HasSubstr("4294967295"));
  EXPECT_THAT(error([](D& d) { d.pose_r[0] = 1; }), HasSubstr("not a rotation"));
  EXPECT_THAT(error([](D& d) { d.pose_r[8] = -1; }), HasSubstr("determinant"));
  EXPECT_THAT(error([](D& d) { d.pose_r[0] = kNan; }), HasSubstr("pose R"));
  EXPECT_THAT(error([](D& d) { d.camera_r[0] = kNan; }), HasSubstr("camera R"));
  EXPECT_THAT(error([](D& d) { d.pose_c[1] = HUGE_VAL; }), HasSubstr("pose C"));
  EXPECT_THAT(error([](D& d) {
                d.camera_c = {0, 1.7e308, 0}, d.pose_c = {-1.7e308, 0, 0};
              }),
              HasSubstr("C of the camera"));
  EXPECT_THAT(error([](D& d) { d.platform = 1; }), HasSubstr("platformID is 1"));
  EXPECT_THAT(error([](D& d) { d.platform = kNoId; }), HasSubstr("platformID"));
  EXPECT_THAT(error([](D& d) { d.camera = 1; }), HasSubstr("cameraID is 1"));
  EXPECT_THAT(error([](D& d) { d.pose = 2; }), HasSubstr("poseID is 2"));
  EXPECT_THAT(error([](D& d) { d.second_id = 40; }), HasSubstr("ID 40"));
  EXPECT_THAT(error([](D& d) { d.name = ""; }), HasSubstr("images[0].name"));
  EXPECT_THAT(error([](D& d) { d.view_image = 3; }), HasSubstr("vertices[0].views"));
  EXPECT_THAT(error([](D& d) { d.score_image = 3; }), HasSubstr("viewScores"));
  EXPECT_THAT(error([](D& d) { d.score_image = 0; }), HasSubstr("own neighbour"));
  EXPECT_THAT(error([](D& d) { d.score = HUGE_VALF; }), HasSubstr("viewScores"));
  EXPECT_THAT(error([](D& d) { d.x = HUGE_VALF; }), HasSubstr("vertices[0]"));
  EXPECT_THAT(error([](D& d) { d.third_image = false; }), HasSubstr("at least 2"));
  for (const std::uint64_t size :
       {std::uint64_t{1} << 32, ~std::uint64_t{0}, std::uint64_t{1000}}) {
    EXPECT_THAT(error([&](D& d) { d.vertices = size; }), HasSubstr("vertices"));
    EXPECT_THAT(error([&](D& d) { d.colors = size; }), HasSubstr("verticesColor"));
  }
}

TEST_F(MvsTest, ToleratesAnUncalibratedImageWithoutACamera) {
  Description d;
  d.pose = d.platform = d.camera = kNoId;
  EXPECT_FALSE(read(d).images[0].calibrated);
}

TEST_F(MvsTest, RefusesOtherFiles) {
  const auto message = [&](std::string_view bytes) {
    test::put(file_, bytes);
    return error_of([&] { read_mvs(file_, folder_); });
  };
  EXPECT_THAT(message(std::string_view("MVS\0\1\0\0\0", 8)), HasSubstr("archive type -1"));
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THAT(message("garbage that is no scene"), HasSubstr("version 0"));
  EXPECT_THAT(message(bytes_of({}) + "x"), HasSubstr("1 bytes follow"));
  test::put(folder_ / "scene.ply", "garbage that is no scene");
  EXPECT_THAT(error_of([&] { read_mvs(folder_ / "scene.ply", folder_); }), HasSubstr("not a .mvs"));
  EXPECT_THAT(error_of([&] { read_mvs(folder_ / "none.mvs", folder_); }), HasSubstr("none.mvs"));
  EXPECT_THAT(error_of([&] { read_mvs(folder_, folder_); }), HasSubstr("folder"));
}

TEST_F(MvsTest, SurvivesWrongInput) {
  const auto reader = [&](const fs::path& file) { read_mvs(file, folder_); };
  for (const unsigned version : {1u, 4u, 7u}) {
    Description d;
    d.version = version;
    test::expect_prefixes_refused(file_, bytes_of(d), reader);
    test::expect_damage_survived(file_, bytes_of(d), reader, 12);
  }
}

}  // namespace
}  // namespace axial::io
