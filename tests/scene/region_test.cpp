// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/region.h"

#include <gtest/gtest.h>

#include "support/analytic_scene.h"

namespace axial {
namespace {

// Eight cameras on a horizontal circle around the origin, looking at the origin.
Scene ring(double radius) {
  Scene scene;
  for (int i = 0; i < 8; ++i) {
    const double angle = 3.14159265358979 / 4 * i;
    SceneImage image;
    image.camera = test::dry_camera();
    image.pose.centre = {radius * std::cos(angle), radius * std::sin(angle), 0};
    const Eigen::Vector3d z = -image.pose.centre.normalized(), y(0, 0, -1);
    image.pose.rotation << y.cross(z).transpose(), y.transpose(), z.transpose();
    scene.images.push_back(image);
  }
  return scene;
}

void add_point(Scene& scene, const Eigen::Vector3f& position) {
  SparsePoint point;
  point.position = position;
  for (std::uint32_t i = 0; i < scene.images.size(); ++i) point.views.push_back({i, 0});
  scene.points.push_back(point);
}

TEST(EstimateRegion, BoxesWhatTheCamerasSurround) {
  Scene scene = ring(3);
  for (const float s : {-0.5f, 0.5f}) add_point(scene, {s, 2 * s, 0.2f * s});
  add_point(scene, {0, 0, 0});
  scene.points.push_back(scene.points.back());
  // A point far behind the circle's centre, as seen from its only camera, must not count.
  scene.points.back().position = {100, 0, 0};
  scene.points.back().views = {{4, 0}};
  for (const RegionMode mode : {RegionMode::on, RegionMode::adaptive}) {
    const auto region = estimate_region(scene, mode);
    ASSERT_TRUE(region);
    EXPECT_LT(region->centre.norm(), 1e-6);
    EXPECT_LT((region->half_extent - Eigen::Vector3d(0.55, 1.1, 0.11)).norm(), 1e-6);
  }
  EXPECT_FALSE(estimate_region(scene, RegionMode::off));
}

TEST(EstimateRegion, KeepsAVolumeAroundPointsInOnePlane) {
  Scene scene = ring(3);
  for (const float s : {-0.5f, 0.5f}) add_point(scene, {s, 2 * s, 0});
  const auto region = estimate_region(scene, RegionMode::on);
  ASSERT_TRUE(region);
  // 1.1 times half of the extents 1 and 2. The third extent is 0 and becomes a tenth of the
  // largest.
  EXPECT_LT((region->half_extent - Eigen::Vector3d(0.55, 1.1, 0.11)).norm(), 1e-6);
}

TEST(EstimateRegion, LeavesASurveyUnbounded) {
  Scene scene = test::scene_of(test::dry_camera(), test::circle_of_poses(6));
  add_point(scene, {0, 0, 1});
  EXPECT_FALSE(estimate_region(scene, RegionMode::adaptive));
  EXPECT_TRUE(estimate_region(scene, RegionMode::on));
}

TEST(EstimateRegion, NeedsThreeCamerasAndAPoint) {
  Scene scene = ring(3);
  EXPECT_FALSE(estimate_region(scene, RegionMode::on));
  add_point(scene, {0, 0, 0});
  for (std::size_t i = 2; i < scene.images.size(); ++i) scene.images[i].calibrated = false;
  EXPECT_FALSE(estimate_region(scene, RegionMode::on));
}

TEST(WithBorder, MultipliesOrAdds) {
  OrientedBox box;
  box.half_extent = {1, 2, 3};
  EXPECT_EQ(with_border(box, 10).half_extent, Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(with_border(box, -0.5).half_extent, Eigen::Vector3d(1.5, 2.5, 3.5));
  EXPECT_EQ(with_border(box, 0).half_extent, box.half_extent);
}

}  // namespace
}  // namespace axial
