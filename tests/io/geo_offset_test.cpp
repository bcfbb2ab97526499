// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/geo_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/atomic_file.h"
#include "io/colmap/colmap_frame.h"
#include "io/wrong_input.h"
#include "scene/camera_model.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

const LocalFrame kFar{{534000, 3378500, -0.125}};

class GeoOffset : public test::FolderTest {
 protected:
  fs::path scene_ = folder_ / "a.scene.mvs", file_ = folder_ / "a.scene.geo.json";
};

Scene scene_at(const Eigen::Vector3d& centre) {
  Scene scene;
  for (int i = 0; i < 3; ++i)
    scene.images.emplace_back().pose.centre = centre + Eigen::Vector3d(0.1 * i, 0, 0);
  scene.points.emplace_back().position = centre.cast<float>();
  return scene;
}

TEST_F(GeoOffset, IsReadAsItWasWritten) {
  EXPECT_FALSE(read_geo_offset_beside(scene_));
  write_geo_offset_beside(scene_, kFar);
  ASSERT_TRUE(fs::exists(file_));
  EXPECT_EQ(read_geo_offset_beside(scene_)->origin, kFar.origin);
  write_geo_offset_beside(scene_, {});  // a scene near the origin replaces an older scene
  EXPECT_FALSE(fs::exists(file_));
  write_geo_offset_beside(scene_, {});
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(GeoOffset, WrongFilesAreOneLine) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {R"({"version": 2, "geo_offset": [1, 2, 3]})", "version is 2"},
           {R"({"version": 1, "geo_offset": [1, 2]})", "geo.geo_offset is [1,2]"},
           {R"({"version": 1, "geo_offset": [1, 2, "3"]})", "expected 3 numbers"},
           {R"({"version": 1, "geo_offset": 7})", "expected 3 numbers"},
           {R"({"version": 1})", "geo_offset"},
           {R"({"version": 1, "geo_offset": [1, 2, 3], "crs": 4326})", "crs"},
           {R"({"version": 1, "geo_offset": [1, 2, 1e999]})", "a.scene.geo.json"},
           {"[1, 2, 3]", "a.scene.geo.json"}}) {
    test::put(file_, text + "\n");
    const std::string message = error_of([&] { read_geo_offset_beside(scene_); });
    EXPECT_THAT(message, HasSubstr(file_.string())) << text;
    EXPECT_THAT(message, HasSubstr(expected)) << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << text;
  }
}

TEST_F(GeoOffset, ASceneKeepsTheFileBesideIt) {
  write_geo_offset_beside(scene_, kFar);
  Scene scene = scene_at({1, 2, 3});
  test::CapturedEvents log;
  EXPECT_EQ(enter_local_frame(scene, scene_, log.context).origin, kFar.origin);
  EXPECT_EQ(scene.images[0].pose.centre, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(log.lines, "");
}

TEST_F(GeoOffset, ASceneWithAnotherOnesFileIsSaid) {
  write_geo_offset_beside(scene_, kFar);
  Scene scene = scene_at({534000, 3378500, 0});
  test::CapturedEvents log;
  enter_local_frame(scene, scene_, log.context);
  EXPECT_THAT(log.lines, HasSubstr(file_.string()));
  EXPECT_THAT(log.lines, HasSubstr(" m from this origin"));
}

TEST_F(GeoOffset, AFarSceneWithoutAFileEntersAFrame) {
  Scene scene = scene_at({534012, 3378476, 7});
  test::CapturedEvents log;
  EXPECT_EQ(enter_local_frame(scene, scene_, log.context).origin,
            Eigen::Vector3d(534010, 3378480, 10));
  EXPECT_EQ(scene.images[0].pose.centre, Eigen::Vector3d(2, -4, -3));
  EXPECT_EQ(scene.points[0].position, Eigen::Vector3f(2, -4, -3));
  EXPECT_THAT(log.lines, HasSubstr("a resolution of only 0.25 m"));
}

TEST_F(GeoOffset, ANearSceneStaysAsItIs) {
  Scene scene = scene_at({0, 200.1, 3});
  scene.images[0].pose.centre.x() = -0.0;
  test::CapturedEvents log;
  EXPECT_TRUE(enter_local_frame(scene, scene_, log.context).is_world());
  EXPECT_TRUE(std::signbit(scene.images[0].pose.centre.x()));
  EXPECT_EQ(log.lines, "");
}

TEST_F(GeoOffset, ModelsGoIntoAFrameAndBack) {
  ColmapModel model;
  for (int i = 0; i < 3; ++i)
    model.images.emplace_back().pose.centre = Eigen::Vector3d(534000.25 + i, 3378500.5, 30);
  model.points.emplace_back().position = {534001, 3378502.125, 28};
  ColmapModel local = model;
  const LocalFrame frame = enter_local_frame(local);
  EXPECT_EQ(frame.origin, Eigen::Vector3d(534000, 3378500, 30));
  EXPECT_EQ(local.images[1].pose.centre, Eigen::Vector3d(1.25, 0.5, 0));
  EXPECT_EQ(local.points[0].position, Eigen::Vector3d(1, 2.125, -2));
  leave(frame, local);
  EXPECT_EQ(local.images[1].pose.centre, model.images[1].pose.centre);
  EXPECT_EQ(local.points[0].position, model.points[0].position);
}

TEST_F(GeoOffset, WaterSurfacesMoveWithTheirScene) {
  WaterSurface lake;
  lake.point = {534000, 3378500, 28.5};
  refractive::FlatPort<double> port;
  port.distance = 0.02;
  Housing housing = housing_with(lake);
  housing.ports["flat"] = port;
  const LocalFrame frame{{533900, 3378600, 0}};
  const Pose pose{Eigen::Vector3d(1, -1, -1).asDiagonal(), {534003, 3378501, 30}};
  const Pose local{pose.rotation, frame.to_local(pose.centre)};
  const Housing moved = in_frame(frame, housing);
  const auto in_world = housing.port_at("main", pose, "a");
  const auto in_local = moved.port_at("main", local, "a");
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(*in_world).distance, 1.5);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(*in_local).distance, 1.5);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(moved.ports.at("flat")).distance, 0.02);
}

// Moves cameras, housings and points together: every point keeps its pixel.

Similarity turned(double scale) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  return {scale, Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), {4, -5, 6}};
}

// The pixel of `x` behind the port of the housing.
Eigen::Vector2d pixel(const Housing& housing, const Pose& pose, const Eigen::Vector3d& x) {
  CameraModel model{640, 480, {500, 500, 319.5, 239.5}, housing.port_at("main", pose, "image")};
  return std::visit(
      [&](const auto& camera) -> Eigen::Vector2d {
        return camera.project(pose.to_camera(x)).pixel;
      },
      make_camera<double>(model));
}

void expect_same_pixels(const HousingPort& port, double scale, bool scale_ports) {
  const Housing housing = housing_with(port);
  const Similarity similarity = turned(scale);
  const Housing after = moved(similarity, housing, scale_ports);
  const Pose pose;
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(0.3, -0.2, 1.5), Eigen::Vector3d(-0.5, 0, 2)})
    EXPECT_LT((pixel(after, similarity(pose), similarity(x)) - pixel(housing, pose, x)).norm(),
              1e-8);
}

const Eigen::Vector3d kTilt = Eigen::Vector3d(0.1, 0.05, 1).normalized();

TEST(MovedHousing, RigidMotionsKeepThePorts) {
  expect_same_pixels(refractive::FlatPort<double>{kTilt, 0.02, 0.01, 1, 1.5, 1.33}, 1, false);
  expect_same_pixels(refractive::DomePort<double>{{0, 0.01, 0}, 0.1, 0.01, 1, 1.5, 1.33}, 1, false);
}

TEST(MovedHousing, PortsScaleWithTheScene) {
  expect_same_pixels(refractive::FlatPort<double>{kTilt, 0.02, 0.01, 1, 1.5, 1.33}, 2.5, true);
  expect_same_pixels(refractive::DomePort<double>{{0, 0.01, 0}, 0.1, 0.01, 1, 1.5, 1.33}, 2.5,
                     true);
  const Housing same =
      moved(turned(2.5), housing_with(refractive::FlatPort<double>{kTilt, 0.02}), false);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(same.ports.at("main")).distance, 0.02);
}

TEST(MovedHousing, WaterSurfacesMoveWithTheScene) {
  for (const bool scale_ports : {false, true})
    expect_same_pixels(WaterSurface{kTilt, {0.5, 0, 0.3}, 1, 1.33}, 2.5, scale_ports);
}

}  // namespace
}  // namespace axial::io
