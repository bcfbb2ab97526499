// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the camera type that make_camera_list() chooses for each mixture of housings.
#include "scene/camera_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/analytic_scene.h"
#include "support/error_of.h"

namespace axial {
namespace {

using testing::HasSubstr;

CameraModel behind_dome() {
  CameraModel model = test::dry_camera();
  model.port = refractive::DomePort<double>{{0.003, 0.002, -0.004}, 0.05, 0.007, 1, 1.49, 1.34};
  return model;
}

CameraModel with_barrel(CameraModel model) {
  model.distortion.emplace();
  model.distortion->above[1] = -0.05;
  return model;
}

TEST(CameraList, IsOfTheKindOfItsPorts) {
  const CameraModel dry = test::dry_camera(), flat = test::behind_port(dry), dome = behind_dome();
  const auto kind = [](std::vector<CameraModel> models, ProjectionMethod method) {
    return make_camera_list<float>(models, method).index();
  };
  constexpr auto kExact = ProjectionMethod::exact;
  EXPECT_EQ(kind({dry, dry}, kExact), 0u);
  EXPECT_EQ(kind({dry, dry}, ProjectionMethod::line_search), 0u);
  EXPECT_EQ(kind({flat, dry}, kExact), 1u);
  EXPECT_EQ(kind({dry, dome}, kExact), 2u);
  EXPECT_EQ(kind({dry, flat}, ProjectionMethod::line_search), 3u);
  EXPECT_EQ(kind({dry, with_barrel(dry)}, kExact), 4u);
  EXPECT_EQ(kind({flat, with_barrel(dry)}, kExact), 5u);
  EXPECT_EQ(kind({with_barrel(dome), dry}, kExact), 6u);
  EXPECT_EQ(kind({flat, dome}, kExact), 7u);
  EXPECT_EQ(kind({dry, with_barrel(dome), flat}, kExact), 7u);
}

// A camera without a port has the same rays and pixels in a list with any other camera.
TEST(CameraList, LeavesDryCamerasDry) {
  const CameraModel dry = test::dry_camera();
  const auto alone = std::get<refractive::PinholeCamera<double>>(make_camera<double>(dry));
  for (const CameraModel& other :
       {test::behind_port(dry), behind_dome(), with_barrel(dry),
        with_barrel(test::behind_port(dry)), with_barrel(behind_dome())}) {
    const std::vector<CameraModel> models{dry, other};
    std::visit(
        [&](const auto& cameras) {
          for (const Eigen::Vector2d& pixel :
               {Eigen::Vector2d(3, 60), Eigen::Vector2d(47.2, 36.1)}) {
            const auto ray = cameras[0].ray(pixel);
            EXPECT_LT((ray.direction - alone.ray(pixel).direction).norm(), 1e-14);
            EXPECT_LT(ray.origin.norm(), 1e-14);
            for (const double distance : {0.01, 3.0})
              EXPECT_LT((cameras[0].project(ray.at(distance)).pixel - pixel).norm(), 1e-9);
          }
        },
        make_camera_list<double>(models));
  }
}

// The lens is the same for a camera made alone and in a list, and at every resolution.
TEST(CameraList, KeepsTheLens) {
  const CameraModel barrel = with_barrel(test::behind_port(test::dry_camera()));
  const std::vector<CameraModel> models{barrel};
  const Eigen::Vector2d pixel(3, 60);
  using Camera = refractive::LensFlatPortCamera<double>;
  const auto listed = std::get<std::vector<Camera>>(make_camera_list<double>(models))[0];
  const auto alone = std::get<Camera>(make_camera<double>(barrel));
  EXPECT_EQ(listed.ray(pixel).direction, alone.ray(pixel).direction);
  const auto doubled =
      std::get<Camera>(make_camera<double>(barrel.resized(2 * barrel.width, 2 * barrel.height)));
  const Eigen::Vector2d there = 2 * (pixel.array() + 0.5) - 0.5;
  EXPECT_LT((doubled.ray(there).direction - alone.ray(pixel).direction).norm(), 1e-14);
  // It differs from the lens without distortion.
  CameraModel straight = barrel;
  straight.distortion.reset();
  const auto other =
      std::get<refractive::FlatPortCamera<double>>(make_camera<double>(straight)).ray(pixel);
  EXPECT_GT((other.direction - alone.ray(pixel).direction).norm(), 1e-3);
}

// In a list with flat ports and domes, every camera is identical to the camera made alone.
TEST(CameraList, LeavesEachItsOwnKindWherePortsDiffer) {
  const CameraModel dry = test::dry_camera(), flat = test::behind_port(dry), dome = behind_dome();
  const std::vector<CameraModel> models{
      flat, dome, dry, with_barrel(dry), with_barrel(flat), with_barrel(dome)};
  const auto cameras = std::get<std::vector<AnyCamera<float>>>(make_camera_list<float>(models));
  ASSERT_EQ(cameras.size(), models.size());
  const Eigen::Vector2f pixel(47.2f, 20.1f);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto alone = make_camera<float>(models[i]);
    EXPECT_EQ(cameras[i].kind().index(), alone.index());
    std::visit(
        [&](const auto& camera) {
          const auto ray = camera.ray(pixel);
          EXPECT_EQ(cameras[i].ray(pixel).direction, ray.direction);
          EXPECT_EQ(cameras[i].ray(pixel).origin, ray.origin);
          EXPECT_EQ(cameras[i].project(ray.at(2)).pixel, camera.project(ray.at(2)).pixel);
        },
        alone);
  }
}

TEST(CameraList, RefusesWhatCannotBeMatched) {
  const CameraModel dry = test::dry_camera();
  const std::vector<CameraModel> mixed{test::behind_port(dry), behind_dome()};
  EXPECT_THAT(
      test::error_of([&] { make_camera_list<float>(mixed, ProjectionMethod::line_search); }),
      HasSubstr("projection line-search"));
  const std::vector<CameraModel> dome{behind_dome()};
  EXPECT_THAT(test::error_of([&] { make_camera_list<float>(dome, ProjectionMethod::line_search); }),
              HasSubstr("projection line-search"));
  const std::vector<CameraModel> barrel{with_barrel(test::behind_port(dry))};
  EXPECT_THAT(
      test::error_of([&] { make_camera_list<float>(barrel, ProjectionMethod::line_search); }),
      HasSubstr("undistort the images first"));
}

}  // namespace
}  // namespace axial
