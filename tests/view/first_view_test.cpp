// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/first_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "view/random_cloud.h"

namespace axial::view {
namespace {

SceneImage looking_along_z(double turn) {
  SceneImage image;
  image.pose.rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return image;
}

TEST(FirstView, ShowsTheCloudAsThePhotographsSeeIt) {
  PointCloud cloud = testing::random_cloud(20000);
  cloud.positions[3] = {1e6f, 0, 0};  // a far point does not change the view
  const std::vector<SceneImage> images{looking_along_z(0.2), looking_along_z(-0.2)};
  const FirstView view = first_view(cloud, images, false);
  EXPECT_LT((view.centre - Eigen::Vector3d(-6, 0.5, 0.25)).norm(), 0.03);
  EXPECT_NEAR(view.radius, 0.97, 0.05);  // of nine of ten points of the box 2 x 1 x 0.5
  EXPECT_LT((view.towards - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((view.up - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
}

TEST(FirstView, NeverLooksAlongUp) {
  const PointCloud cloud = testing::random_cloud(10);
  // Two photographs with opposite upward directions; photographs that look along the z axis.
  const std::vector<SceneImage> opposite{looking_along_z(0), looking_along_z(3.14159265358979)};
  for (const bool z_is_up : {false, true}) {
    const FirstView view = first_view(cloud, opposite, z_is_up);
    EXPECT_NEAR(view.up.norm(), 1, 1e-12);
    EXPECT_NEAR(view.towards.norm(), 1, 1e-12);
    EXPECT_GT(view.up.cross(view.towards).norm(), 0.05);
  }
}

}  // namespace
}  // namespace axial::view
