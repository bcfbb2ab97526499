// SPDX-License-Identifier: GPL-3.0-or-later
// Tests crop(), estimate_colors() and estimate_normals().
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "cloud/colors.h"
#include "cloud/crop.h"
#include "cloud/normals.h"
#include "scene/camera_model.h"
#include "support/analytic_scene.h"

namespace axial::cloud {
namespace {

// Points on the analytic scene's plane, each seen by two of three cameras.
PointCloud plane_cloud(int side) {
  const test::AnalyticScene world;
  PointCloud cloud;
  cloud.view_begin = {0};
  for (int i = 0; i < side * side; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const Eigen::Vector3d x(0.6f * unit_float(scramble(key)) - 0.3f,
                            0.6f * unit_float(scramble(~key)) - 0.3f, 1);
    cloud.positions.push_back(world.plane.projection(x).cast<float>());
    const auto first = static_cast<std::uint32_t>(i % 2);
    cloud.view_images.insert(cloud.view_images.end(), {first, first + 1});
    cloud.view_weights.insert(cloud.view_weights.end(), {1.0f, 2.0f + static_cast<float>(i)});
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  return cloud;
}

Scene three_cameras(const CameraModel& model) {
  return test::scene_of(model, test::circle_of_poses(3));
}

TEST(Crop, KeepsOrderAndAttributes) {
  PointCloud cloud = plane_cloud(20);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals.emplace_back(0.0f, 0.0f, static_cast<float>(i));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), 0, 0});
  }
  const PointCloud before = cloud;
  OrientedBox region;
  region.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  region.centre = {0.1, 0, 1};
  region.half_extent = {0.2, 0.3, 5};
  const std::size_t removed = crop(cloud, region);
  ASSERT_EQ(cloud.size() + removed, before.size());
  ASSERT_EQ(cloud.view_begin.size(), cloud.size() + 1);
  std::size_t k = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!region.contains(before.positions[i].cast<double>())) continue;
    ASSERT_LT(k, cloud.size());
    EXPECT_EQ(cloud.positions[k], before.positions[i]);
    EXPECT_EQ(cloud.normals[k], before.normals[i]);
    EXPECT_EQ(cloud.colors[k], before.colors[i]);
    EXPECT_EQ(cloud.views_of(k)[1], before.views_of(i)[1]);
    EXPECT_EQ(cloud.view_weights[cloud.view_begin[k] + 1],
              before.view_weights[before.view_begin[i] + 1]);
    ++k;
  }
  EXPECT_EQ(k, cloud.size());
  EXPECT_GT(k, 10u);
  EXPECT_GT(removed, 10u);
}

TEST(EstimateColors, SamplesTheNearestView) {
  for (const CameraModel& model : {test::dry_camera(), test::behind_port(test::dry_camera())}) {
    const Scene scene = three_cameras(model);
    PointCloud cloud = plane_cloud(15);
    cloud.positions[3] = {0, 50, 1};  // in no image
    // Red grows by 1 per pixel and green by 2, so that bilinear interpolation is exact. Blue
    // encodes the image.
    estimate_colors(cloud, scene, [](std::size_t i) {
      cv::Mat3b image(72, 96);
      for (int y = 0; y < 72; ++y) {
        for (int x = 0; x < 96; ++x)
          image(y, x) = cv::Vec3b(static_cast<unsigned char>(i + 1),
                                  static_cast<unsigned char>(2 * y), static_cast<unsigned char>(x));
      }
      return image;
    });
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (cloud.colors[i] == Rgb{255, 255, 255}) continue;
      const Eigen::Vector3d X = cloud.positions[i].cast<double>();
      const auto a = cloud.views_of(i)[0], b = cloud.views_of(i)[1];
      const double depth_a = scene.images[a].pose.to_camera(X).z();
      const double depth_b = scene.images[b].pose.to_camera(X).z();
      const auto nearest = depth_b < depth_a ? b : a;
      ASSERT_EQ(cloud.colors[i][2], nearest + 1);
      const auto camera = make_camera<double>(model);
      const Eigen::Vector2d pixel = std::visit(
          [&](const auto& c) -> Eigen::Vector2d {
            return c.project(scene.images[nearest].pose.to_camera(X)).pixel;
          },
          camera);
      ASSERT_NEAR(cloud.colors[i][0], pixel.x(), 0.51);
      ASSERT_NEAR(cloud.colors[i][1], 2 * pixel.y(), 0.51);
    }
    EXPECT_EQ(cloud.colors[3], (Rgb{255, 255, 255}));
    const auto white = std::count(cloud.colors.begin(), cloud.colors.end(), Rgb{255, 255, 255});
    EXPECT_LT(white, 60);
  }
}

TEST(EstimateColors, NeedsViews) {
  PointCloud cloud;
  cloud.positions.resize(2, Eigen::Vector3f::Zero());
  EXPECT_THROW(estimate_colors(cloud, {}, {}), Error);
}

TEST(EstimateNormals, FacesTheFirstView) {
  const Scene scene = three_cameras(test::dry_camera());
  PointCloud cloud = plane_cloud(20);
  estimate_normals(cloud, scene);
  const test::AnalyticScene world;
  ASSERT_EQ(cloud.normals.size(), cloud.size());
  for (const Eigen::Vector3f& n : cloud.normals) {
    // Positions have rounding errors of 6e-8 in neighbourhoods of some centimetres.
    ASSERT_LT((n.cast<double>() - world.plane.normal()).norm(), 1e-4);
  }
}

TEST(EstimateNormals, CopesWithFewPointsAndNoViews) {
  const Scene scene = three_cameras(test::dry_camera());
  PointCloud cloud;
  estimate_normals(cloud, scene);
  EXPECT_TRUE(cloud.normals.empty());
  cloud.positions = {{0, 0, 1}, {0, 0, 1}};
  estimate_normals(cloud, scene);
  for (const Eigen::Vector3f& n : cloud.normals) EXPECT_LT(n.z(), -0.9f);
}

}  // namespace
}  // namespace axial::cloud
