// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/weak_support.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <initializer_list>
#include <random>
#include <set>

#include "mesh/reconstruct.h"

namespace axial::mesh {
namespace {

// A floor of few points in front of a wall of many. Cameras look over the floor at the wall, so
// their rays to the wall show that the space above the floor is free. Some points lie below the
// floor by mistake. Their rays cross the floor, and are more than the rays of the floor's points.
struct FloorAndWall {
  static constexpr std::size_t kFloor = 81;

  FloorAndWall() {
    for (const double y : {-0.3, 0.0, 0.3}) add_camera({-1, y, 0.4}, {0.5, 0, 0.1});
    cloud.view_begin.push_back(0);
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j)
        add_point({0.08 * i + spread(0.02), 0.1 * j - 0.4 + spread(0.02), spread(0.002)}, {0, 2});
    for (int i = 0; i < 200; ++i)
      add_point({0.35 + spread(0.35), spread(0.45), -0.2 + spread(0.15)}, {0, 1});
    for (int i = 0; i < 50; ++i)
      for (int j = 0; j < 30; ++j)
        add_point({0.8 + spread(0.002), 0.02 * i - 0.5 + spread(0.005), 0.02 * j}, {0, 1, 2});
  }

  double spread(double most) { return std::uniform_real_distribution<double>(-most, most)(random); }

  void add_camera(const Eigen::Vector3d& centre, const Eigen::Vector3d& target) {
    SceneImage& image = scene.images.emplace_back();
    image.path = "image";
    image.camera.width = image.camera.height = 400;
    image.camera.lens = {300, 300, 199.5, 199.5};
    image.pose.rotation =
        Eigen::Quaterniond::FromTwoVectors(target - centre, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    image.pose.centre = centre;
  }

  void add_point(const Eigen::Vector3d& at, std::initializer_list<std::uint32_t> views) {
    cloud.positions.push_back(at.cast<float>());
    cloud.view_images.insert(cloud.view_images.end(), views);
    cloud.view_begin.push_back(cloud.view_images.size());
  }

  std::mt19937 random{1};
  Scene scene;
  PointCloud cloud;
};

// The number of points of the floor that are vertices of the mesh.
std::size_t floor_points_in(const Mesh& mesh, const PointCloud& cloud) {
  const auto less = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const std::set<Eigen::Vector3f, decltype(less)> vertices(mesh.vertices.begin(),
                                                           mesh.vertices.end(), less);
  std::size_t count = 0;
  for (std::size_t i = 0; i < FloorAndWall::kFloor; ++i)
    count += vertices.contains(cloud.positions[i]);
  return count;
}

// Without the option, the rays that cross the floor outweigh its points, and the floor is lost.
TEST(WeakSupport, AFloorOfFewPointsIsKept) {
  const FloorAndWall seen;
  ReconstructOptions options;
  options.merge.min_distance = 0;
  options.clean.spurious = 0;  // the edges of the floor are long
  const Mesh without = reconstruct(seen.cloud, seen.scene, options);
  options.votes.weak_support = true;
  const Mesh with = reconstruct(seen.cloud, seen.scene, options);
  EXPECT_LT(floor_points_in(without, seen.cloud), FloorAndWall::kFloor / 4);
  EXPECT_GT(floor_points_in(with, seen.cloud), FloorAndWall::kFloor * 3 / 4);
}

}  // namespace
}  // namespace axial::mesh
