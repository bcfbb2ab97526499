// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/geo_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/log.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

const LocalFrame kFar{{534000, 3378500, -0.125}};

class GeoOffset : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::empty_folder();
    scene_ = folder_ / "a.scene.mvs";
    file_ = folder_ / "a.scene.geo.json";
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_, scene_, file_;
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
           {R"({"version": 1, "geo_offset": [1, 2, "3"]})", "expected three numbers"},
           {R"({"version": 1, "geo_offset": 7})", "expected three numbers"},
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
  const LogCapture log;
  EXPECT_EQ(enter_local_frame(scene, scene_).origin, kFar.origin);
  EXPECT_EQ(scene.images[0].pose.centre, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(log.text(), "");
}

TEST_F(GeoOffset, ASceneWithAnotherOnesFileIsSaid) {
  write_geo_offset_beside(scene_, kFar);
  Scene scene = scene_at({534000, 3378500, 0});
  const LogCapture log;
  enter_local_frame(scene, scene_);
  EXPECT_THAT(log.text(), HasSubstr(file_.string()));
  EXPECT_THAT(log.text(), HasSubstr(" m from this origin"));
}

TEST_F(GeoOffset, AFarSceneWithoutAFileEntersAFrame) {
  Scene scene = scene_at({534012, 3378476, 7});
  const LogCapture log;
  EXPECT_EQ(enter_local_frame(scene, scene_).origin, Eigen::Vector3d(534010, 3378480, 10));
  EXPECT_EQ(scene.images[0].pose.centre, Eigen::Vector3d(2, -4, -3));
  EXPECT_EQ(scene.points[0].position, Eigen::Vector3f(2, -4, -3));
  EXPECT_THAT(log.text(), HasSubstr("a resolution of only 0.25 m"));
}

TEST_F(GeoOffset, ANearSceneStaysAsItIs) {
  Scene scene = scene_at({0, 200.1, 3});
  scene.images[0].pose.centre.x() = -0.0;
  const LogCapture log;
  EXPECT_TRUE(enter_local_frame(scene, scene_).is_world());
  EXPECT_TRUE(std::signbit(scene.images[0].pose.centre.x()));
  EXPECT_EQ(log.text(), "");
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

}  // namespace
}  // namespace axial::io
