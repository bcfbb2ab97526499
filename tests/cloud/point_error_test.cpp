// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "drawn.h"
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

constexpr Surroundings kPlain{0.01, 0};

// The supports of a point: in every view the pixel nearest to the point's image, with the depth at
// which the pixel's ray is nearest to the point.
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

// The oracle: adds noise to the pixels of the point and triangulates them by minimising the
// reprojection error (Gauss-Newton). Returns the standard deviation of the points along `normal`.
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
                     axial::test::drawn<2>(pixel_noise, random));
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
        // The noise is so small that the oracle is linear. Three errors remain: the sampling error
        // of 1000 trials is 2.2 % (one sigma), rounding to the nearest pixel changes the Jacobian
        // by 1 %, and the bound for parallel rays lowers the result by up to 4 % if the angle
        // between the rays is 6 degrees.
        const double oracle = oracle_error(model(), poses, point, normal, 0.01) / 0.01;
        EXPECT_NEAR(found / oracle, 1, 0.09) << count << " views, radius " << radius;
      }
}

TEST_P(PointErrorWithCamera, GrowsWithTheSquareOfTheDistanceWhereAnglesAreSmall) {
  const Eigen::Vector3d normal(0, 0, -1);
  const auto error = [&](double distance) {
    // The point lies midway between two cameras; pixels are not rounded.
    const Eigen::Vector3d point(0, 0, distance);
    std::vector<PointSupport> supports = supports_of(model(), test::circle_of_poses(2), point);
    for (const double side : {-1.0, 1.0}) {
      PointSupport& support = supports[side > 0];
      support.ray = (point - Eigen::Vector3d(0.1 * side, 0, 0)).normalized();
      support.pixel *= distance / support.depth;
      support.depth = distance;
    }
    return triangulated_error(supports, normal);
  };
  for (const double distance : {0.5, 1.0, 1.5})
    EXPECT_NEAR(error(2 * distance) / error(distance), 4, 0.2) << distance;
}

// Compares with the camera's projection as the oracle, over the whole image including the corners.
TEST_P(PointErrorWithCamera, SupportsHaveTheCamerasRaysAndPixels) {
  const CameraModel dry_or_wet = model();
  const AnyCamera<double> camera(make_camera<double>(dry_or_wet));
  const Pose pose = test::circle_of_poses(3, 0.4)[1];
  const SupportCamera view(dry_or_wet, pose);
  const int width = dry_or_wet.width, height = dry_or_wet.height;
  for (int y = 0; y < height; y += height / 7 - 1)
    for (int x = 0; x < width; x += width / 7 - 1)
      for (const double depth : {0.5, 2.0}) {
        const auto ray = camera.ray({x, y});
        refractive::Matrix23<double> J;
        camera.project(ray.at(depth), &J);
        const PointSupport support = view.support(static_cast<std::uint32_t>(y * width + x), depth,
                                                  0.1, pose.to_world(ray.at(depth)));
        EXPECT_NEAR(support.pixel * std::sqrt(0.5 * J.squaredNorm()), 1, 0.05) << x << " " << y;
        EXPECT_LT((pose.rotation * support.ray).cross(ray.direction).norm(), 0.02);
        EXPECT_NEAR(support.ray.norm(), 1, 1e-9);
      }
}

// The supports with all points moved to `point`, as if the maps agreed exactly.
std::vector<PointSupport> agreeing(std::vector<PointSupport> supports,
                                   const Eigen::Vector3d& point) {
  for (PointSupport& support : supports) support.point = point;
  return supports;
}

TEST_P(PointErrorWithCamera, FallsWithTheAngleAndGrowsWithCostReliefAndNoise) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  const auto error = [&](std::size_t views, double radius, double cost, Surroundings around) {
    const auto poses = test::circle_of_poses(views, radius);
    return expected_error(agreeing(supports_of(model(), poses, point, cost), point), normal, around)
        .error;
  };
  for (const std::size_t views : {2u, 3u, 6u}) {
    float wider = 0;
    for (const double radius : {0.4, 0.2, 0.1, 0.05, 0.02}) {
      const float narrow = error(views, radius, 0.1, kPlain);
      EXPECT_GT(narrow, wider) << views << " views, radius " << radius;
      wider = narrow;
    }
    EXPECT_GT(error(views, 0.05, 0.1, kPlain), 1.5f * error(views, 0.1, 0.1, kPlain));
    EXPECT_GT(error(views, 0.2, 0.2, kPlain), 1.1f * error(views, 0.2, 0.1, kPlain));
    EXPECT_GT(error(views, 0.2, 0.1, {0.1, 0}), 2 * error(views, 0.2, 0.1, kPlain));
    EXPECT_GT(error(views, 0.2, 0.1, {0.01, 1}), 2 * error(views, 0.2, 0.1, kPlain));
  }
}

TEST_P(PointErrorWithCamera, CopiesOfTheSameMapsAddNothing) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  const std::vector<PointSupport> two =
      agreeing(supports_of(model(), test::circle_of_poses(2, 0.2), point), point);
  const float once = expected_error(two, normal, kPlain).error;
  std::vector<PointSupport> copies = two;
  for (int n = 2; n < 4; ++n) {
    copies.insert(copies.end(), two.begin(), two.end());
    EXPECT_GE(expected_error(copies, normal, kPlain).error, 0.999f * once);
  }
}

// Random supports of two to twelve maps.
std::vector<PointSupport> random_supports(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<PointSupport> supports(2 + random() % 11);
  for (PointSupport& support : supports) {
    support.depth = 0.5 + uniform(random);
    support.ray = Eigen::Vector3d(uniform(random) - 0.5, uniform(random) - 0.5, 1).normalized();
    support.pixel = support.depth * 1e-3 * (0.7 + 0.3 * uniform(random));
    support.cost = 0.03 + 0.5 * uniform(random);
    support.point = 1e-3 * axial::test::drawn<3>(uniform, random);
  }
  return supports;
}

TEST(PointError, HasTheUnitOfTheScene) {
  std::mt19937 random(1);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, 0.1, -1).normalized();
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<PointSupport> supports = random_supports(random);
    const Surroundings around{0.001 * trial, 0.1};
    const PointError metres = expected_error(supports, normal, around);
    for (PointSupport& support : supports) {
      support.depth *= 1000;
      support.pixel *= 1000;
      support.point *= 1000;
    }
    const PointError millimetres = expected_error(supports, normal, around);
    EXPECT_NEAR(millimetres.error / metres.error, 1000, 0.01);
    EXPECT_NEAR(millimetres.confidence, metres.confidence, 1e-6);
    EXPECT_GT(metres.error, 0);
    EXPECT_GT(metres.confidence, 0.5);
    EXPECT_LT(metres.confidence, 1);
  }
}

TEST(PointError, DoesNotDependOnTheOrderOfTheMaps) {
  std::mt19937 random(2);
  const Eigen::Vector3d normal(0, 0, -1);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<PointSupport> supports = random_supports(random);
    const PointError one = expected_error(supports, normal, kPlain);
    std::shuffle(supports.begin(), supports.end(), random);
    EXPECT_NEAR(expected_error(supports, normal, kPlain).error / one.error, 1, 1e-5);
  }
}

TEST_P(PointErrorWithCamera, IsSureWhereTheMapsAgree) {
  const Eigen::Vector3d point(0, 0, 1), normal(0, 0, -1);
  std::vector<PointSupport> supports =
      agreeing(supports_of(model(), test::circle_of_poses(3, 0.2), point), point);
  const PointError alike = expected_error(supports, normal, kPlain);
  const double offset = 6 * static_cast<double>(alike.error);
  supports[1].point.z() += offset;
  const PointError apart = expected_error(supports, normal, kPlain);
  // The standard deviation of 0, 0 and 1 is 0.577.
  EXPECT_GT(apart.error, 0.5 * offset);
  EXPECT_LT(apart.error, offset);
  EXPECT_GT(alike.confidence, 0.98f);
  EXPECT_LE(alike.confidence, 1.0f);
  EXPECT_GT(1 - apart.confidence, 1.5f * (1 - alike.confidence));
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
       {expected_error(supports_of(model(), test::circle_of_poses(1, 0.2), point), normal, kPlain),
        expected_error(supports_of(model(), test::circle_of_poses(3, 0.2), point, 1.0), normal,
                       kPlain)}) {
    EXPECT_EQ(error.error, 0);
    EXPECT_EQ(error.confidence, 0);
  }
}

// A map of constant depth whose normals rotate about the y axis by `turn` [rad] per pixel, and a
// photograph whose intensity grows by `across` and `down` per pixel.
FusionMap turning_map(double turn, int across, int down, bool photograph = true) {
  DepthMap map;
  map.image_path = "turning";
  map.camera = test::dry_camera();
  const int width = map.camera.width, height = map.camera.height;
  map.depth = cv::Mat1f(height, width, 1.0f);
  map.normal = cv::Mat3f(height, width);
  cv::Mat3b color(height, width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      map.normal(y, x) = {static_cast<float>(std::sin(turn * x)), 0,
                          static_cast<float>(-std::cos(turn * x))};
      color(y, x) = cv::Vec3b::all(static_cast<std::uint8_t>((across * x + down * y) % 200));
    }
  return make_fusion_map(map, photograph ? color : cv::Mat3b());
}

std::uint32_t pixel_at(const FusionMap& map, int x, int y) {
  return static_cast<std::uint32_t>(y * map.depth.cols + x);
}

TEST(Surroundings, TellHowNormalsTurnAndIntensityGrows) {
  const FusionMap map = turning_map(0.02, 3, 4);
  const Surroundings around = surroundings(map, pixel_at(map, 10, 12), 1);
  // Six of the eight surrounding pixels are three columns away; the other two have the same normal.
  EXPECT_NEAR(around.relief, 0.75 * (1 - std::cos(0.06)), 1e-5);
  const Surroundings reduced = surroundings(map, pixel_at(map, 10, 12), 2);
  EXPECT_EQ(reduced.relief, around.relief);
  EXPECT_NEAR(reduced.noise, around.noise / 2, 1e-9) << "a mean of four pixels";
  const FusionMap plainer = turning_map(0, 0, 1);
  EXPECT_NEAR(surroundings(plainer, pixel_at(plainer, 10, 12), 1).noise / around.noise, 5, 1e-6);
  EXPECT_NEAR(surroundings(plainer, pixel_at(plainer, 10, 12), 1).relief, 0, 1e-6);
  const FusionMap plain = turning_map(0, 0, 0), unseen = turning_map(0, 3, 4, false);
  EXPECT_TRUE(std::isfinite(surroundings(plain, pixel_at(plain, 10, 12), 1).noise));
  EXPECT_GT(surroundings(plain, pixel_at(plain, 10, 12), 1).noise, around.noise);
  EXPECT_EQ(surroundings(unseen, pixel_at(unseen, 10, 12), 1).noise, 0);
}

TEST(Surroundings, StayInsideTheImageAndCountKnownNormals) {
  FusionMap map = turning_map(0.02, 3, 4);
  const int right = map.depth.cols - 1, bottom = map.depth.rows - 1;
  for (const int x : {0, right})
    for (const int y : {0, bottom}) {
      const Surroundings around = surroundings(map, pixel_at(map, x, y), 1);
      EXPECT_NEAR(around.relief, 2.0 / 3 * (1 - std::cos(0.06)), 1e-5);
      EXPECT_GT(around.noise, 0);
    }
  map.normal(12, 13) = {0, 0, 0};
  map.normal(12, 7) = {0, 0, 0};
  EXPECT_NEAR(surroundings(map, pixel_at(map, 10, 12), 1).relief, 4.0 / 6 * (1 - std::cos(0.06)),
              1e-5);
  map.normal(12, 10) = {0, 0, 0};
  EXPECT_EQ(surroundings(map, pixel_at(map, 10, 12), 1).relief, 0);
}

}  // namespace
}  // namespace axial::cloud
