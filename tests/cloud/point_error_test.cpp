// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

#include "scene/any_camera.h"
#include "support/analytic_scene.h"

namespace axial::cloud {
namespace {

class PointErrorWithCamera : public testing::TestWithParam<bool> {
 protected:
  static CameraModel model() {
    return GetParam() ? test::behind_port(test::dry_camera()) : test::dry_camera();
  }
};
INSTANTIATE_TEST_SUITE_P(Cameras, PointErrorWithCamera, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

// A point's nearest pixel in every view, and the depth that the pixel's ray has next to the point.
std::vector<PointSupport> supports_of(const CameraModel& model, const std::vector<Pose>& poses,
                                      const Eigen::Vector3d& point, double cost = 0.1) {
  std::vector<PointSupport> supports;
  for (const Pose& pose : poses) {
    const AnyCamera<double> camera(make_camera<double>(model));
    const Eigen::Vector3d X = pose.to_camera(point);
    const Eigen::Vector2d pixel = camera.project(X).pixel.array().round();
    const auto ray = camera.ray(pixel);
    const double depth = (X - ray.origin).dot(ray.direction);
    const SupportCamera view(model, pose);
    supports.push_back(view.support(
        static_cast<std::uint32_t>(pixel.y()) * static_cast<std::uint32_t>(model.width) +
            static_cast<std::uint32_t>(pixel.x()),
        depth, cost, pose.to_world(ray.at(depth))));
  }
  return supports;
}

// The oracle: exact rays through noisy pixels, and the point nearest to all of them by reprojection
// (Gauss-Newton on the cameras' own projections). Standard deviation along `normal`.
double oracle_error(const CameraModel& model, const std::vector<Pose>& poses,
                    const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double noise) {
  const AnyCamera<double> camera(make_camera<double>(model));
  std::mt19937 random(7);
  std::normal_distribution<double> pixel_noise(0, noise);
  double sum = 0;
  constexpr int kTrials = 1000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Eigen::Vector2d> seen;
    for (const Pose& pose : poses)
      seen.push_back(camera.project(pose.to_camera(point)).pixel +
                     Eigen::Vector2d(pixel_noise(random), pixel_noise(random)));
    Eigen::Vector3d X = point;
    for (int step = 0; step < 2; ++step) {
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < poses.size(); ++i) {
        refractive::Matrix23<double> J;
        const auto projection = camera.project(poses[i].to_camera(X), &J);
        const Eigen::Matrix<double, 2, 3> by_world = J * poses[i].rotation;
        A += by_world.transpose() * by_world;
        b += by_world.transpose() * (seen[i] - projection.pixel);
      }
      X += A.ldlt().solve(b);
    }
    sum += std::pow(normal.dot(X - point), 2);
  }
  return std::sqrt(sum / kTrials);
}
TEST_P(PointErrorWithCamera, IsThatOfTriangulation) {
  const Eigen::Vector3d point(0.02, -0.03, 1.0);
  const Eigen::Vector3d upright(0, 0, -1), slanted = Eigen::Vector3d(0.6, 0.2, -1).normalized();
  for (const std::size_t count : {2u, 3u, 6u})
    for (const double radius : {0.05, 0.2})
      for (const Eigen::Vector3d& normal : {upright, slanted}) {
        const std::vector<Pose> poses = test::circle_of_poses(count, radius);
        const double found = triangulated_error(supports_of(model(), poses, point), normal);
        // So little noise that the oracle is linear. Its 1000 trials know a deviation to 2.2 % (one
        // sigma); half a pixel to the nearest one moves the Jacobian by 1 %, and the bound for
        // parallel rays takes up to 4 % where the rays are 6 degrees apart.
        const double oracle = oracle_error(model(), poses, point, normal, 0.01) / 0.01;
        EXPECT_NEAR(found / oracle, 1, 0.09) << count << " views, radius " << radius;
      }
}

TEST_P(PointErrorWithCamera, GrowsWithCostAndFallsWithTheAngle) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  const auto error = [&](std::size_t views, double radius, double cost) {
    return expected_error(supports_of(model(), test::circle_of_poses(views, radius), point, cost),
                          normal)
        .error;
  };
  EXPECT_GT(error(3, 0.2, 0.2), 2 * error(3, 0.2, 0.1));
  EXPECT_GT(error(3, 0.1, 0.1), 1.7f * error(3, 0.2, 0.1));
  // Copies of the same two views add nothing that can be believed.
  std::vector<PointSupport> two = supports_of(model(), test::circle_of_poses(2, 0.2), point);
  const float once = expected_error(two, normal).error;
  for (int copies = 2; copies < 4; ++copies) {
    const std::vector<PointSupport> more =
        supports_of(model(), test::circle_of_poses(2, 0.2), point);
    two.insert(two.end(), more.begin(), more.end());
    EXPECT_GE(expected_error(two, normal).error, 0.999f * once);
  }
}

TEST_P(PointErrorWithCamera, IsConfidentWhereTheMapsAgree) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  std::vector<PointSupport> supports = supports_of(model(), test::circle_of_poses(3, 0.2), point);
  const PointError alike = expected_error(supports, normal);
  supports[1].point.z() += 3 * static_cast<double>(alike.error);
  const PointError apart = expected_error(supports, normal);
  EXPECT_EQ(apart.error, alike.error);
  EXPECT_GT(alike.confidence, 0.99f);
  EXPECT_LE(alike.confidence, 1.0f);
  EXPECT_GT(1 - apart.confidence, 5 * (1 - alike.confidence));
}

TEST_P(PointErrorWithCamera, IsFiniteForRaysThatAreParallel) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  std::vector<Pose> poses = test::circle_of_poses(2, 0.2);
  poses[1] = poses[0];
  const std::vector<PointSupport> supports = supports_of(model(), poses, point);
  EXPECT_LE(triangulated_error(supports, normal), 1.1);
  EXPECT_GT(triangulated_error(supports, normal), 0.9);
}

TEST_P(PointErrorWithCamera, IsUnknownForOneMapOrWithoutCosts) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  for (const PointError& error :
       {expected_error(supports_of(model(), test::circle_of_poses(1, 0.2), point), normal),
        expected_error(supports_of(model(), test::circle_of_poses(3, 0.2), point, 1.0), normal)}) {
    EXPECT_EQ(error.error, 0);
    EXPECT_EQ(error.confidence, 0);
  }
}

}  // namespace
}  // namespace axial::cloud
