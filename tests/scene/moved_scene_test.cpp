// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/moved_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace axial {
namespace {

Similarity turned(double scale, const Eigen::Vector3d& translation) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  return {scale, Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), translation};
}

Scene small_scene() {
  Scene scene;
  for (int i = 0; i < 2; ++i) {
    SceneImage image;
    image.pose.rotation = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitY()).toRotationMatrix();
    image.pose.centre = {0.5 * i, 0, 0};
    image.min_depth = 1;
    image.average_depth = 2;
    image.max_depth = 3;
    scene.images.push_back(image);
  }
  scene.points = {{{0.2f, -0.1f, 2}, {{0, 0}, {1, 0}}}};
  scene.point_normals = {{0, 0, -1}};
  scene.region = OrientedBox{Eigen::Matrix3d::Identity(), {0, 0, 2}, {1, 2, 3}};
  return scene;
}

TEST(MovedScene, EveryCameraSeesThePointsInTheSameDirection) {
  const Scene before = small_scene();
  Scene after = before;
  const Similarity similarity = turned(2.5, {4, -5, 6});
  apply(similarity, after);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto seen = [&](const Scene& scene) {
      return scene.images[i].pose.to_camera(scene.points[0].position.cast<double>());
    };
    // Positions are float, a few metres from the origin.
    EXPECT_LT((seen(after) - 2.5 * seen(before)).norm(), 2e-6);
    EXPECT_FLOAT_EQ(after.images[i].max_depth, 7.5f);
    EXPECT_FLOAT_EQ(after.images[i].min_depth, 2.5f);
  }
  const Eigen::Vector3d normal = after.point_normals[0].cast<double>();
  EXPECT_LT((normal - similarity.rotation * Eigen::Vector3d(0, 0, -1)).norm(), 1e-6);
}

TEST(MovedScene, TheRegionHoldsTheSamePoints) {
  Scene scene = small_scene();
  const OrientedBox before = *scene.region;
  const Similarity similarity = turned(0.3, {1, 1, 1});
  apply(similarity, scene);
  for (int k = 0; k < 27; ++k) {
    const Eigen::Vector3d step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    for (const double reach : {0.99, 1.01}) {
      const Eigen::Vector3d x = before.centre + reach * before.half_extent.cwiseProduct(step);
      EXPECT_EQ(scene.region->contains(similarity(x)), before.contains(x)) << k << " " << reach;
    }
  }
}

TEST(FrameMove, IsTheSameMapInOtherFrames) {
  const LocalFrame here{{500000, 4e6, 0}}, there{{-20, 30, 1000}}, elsewhere{{7, 8, 9}};
  const FrameMove move{turned(1.5, {1, 2, 3}), here, there};
  const Eigen::Vector3d x(0.5, -0.25, 2);
  const Eigen::Vector3d world = there.to_world(move.similarity(x));
  EXPECT_LT((move.between_worlds()(here.to_world(x)) - world).norm(), 1e-8);  // 4e6 has 1e-9
  EXPECT_LT((elsewhere.to_world(move.ending_in(elsewhere).similarity(x)) - world).norm(), 1e-12);
  const FrameMove again = move_in(here, move.between_worlds());
  EXPECT_LT((here.to_world(again.similarity(x)) - world).norm(), 1e-8);
}

}  // namespace
}  // namespace axial
