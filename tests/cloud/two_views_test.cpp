// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/two_views.h"

#include <gtest/gtest.h>

#include "cloud/fuse.h"
#include "support/analytic_scene.h"

namespace axial::cloud {
namespace {

using test::AnalyticScene;

TEST(OnlyWitness, IsTheOneNeighbourThatSeesThePoint) {
  const Answer unseen, lacks = Answer::lacks(), joins = Answer::joins(7),
                       through = Answer::contradicts(7);
  const auto witness = [](const std::vector<Answer>& of_neighbours) {
    std::vector<std::vector<Answer>> answers;
    for (const Answer answer : of_neighbours) answers.push_back({Answer(), answer});
    return only_witness(answers, 1);
  };
  EXPECT_EQ(witness({}), std::nullopt);
  EXPECT_EQ(witness({unseen, unseen}), std::nullopt);
  EXPECT_EQ(witness({unseen, joins, unseen}), 1u);
  EXPECT_EQ(witness({joins, joins}), std::nullopt);
  for (const Answer other : {lacks, through}) {
    EXPECT_EQ(witness({other}), std::nullopt);
    EXPECT_EQ(witness({other, joins}), std::nullopt);
    EXPECT_EQ(witness({joins, other}), std::nullopt);
  }
}

FusionMap wall(float depth) {
  DepthMap map;
  map.camera = test::dry_camera();
  map.depth = cv::Mat1f(map.camera.height, map.camera.width, depth);
  map.normal = cv::Mat3f(map.depth.size(), cv::Vec3f(0, 0, -1));
  return make_fusion_map(map, {});
}

std::uint32_t pixel_at(const FusionMap& map, int x, int y) {
  return static_cast<std::uint32_t>(y * map.depth.cols + x);
}

TEST(InSurface, WantsMostPixelsAroundAtThePixelsDepth) {
  FusionMap map = wall(2);
  const auto here = [&](int x, int y) { return in_surface(map, pixel_at(map, x, y), 0.01f); };
  EXPECT_TRUE(here(20, 20));
  map.depth(20, 20) = 2.1f;  // alone
  EXPECT_FALSE(here(20, 20));
  EXPECT_TRUE(here(22, 22));  // one of eight differs
  map.depth(22, 24) = 2.1f;
  EXPECT_FALSE(here(22, 22));  // two do
  map.depth(22, 24) = 2.01f;   // within 1 %
  EXPECT_TRUE(here(22, 22));
}

TEST(InSurface, HoldsOnBordersAndNotBesideHoles) {
  FusionMap map = wall(2);
  const auto here = [&](int x, int y) { return in_surface(map, pixel_at(map, x, y), 0.01f); };
  for (const int x : {0, 1, map.depth.cols - 1}) EXPECT_TRUE(here(x, 30)) << x;
  for (const int y : {0, 1, map.depth.rows - 1}) EXPECT_TRUE(here(30, y)) << y;
  EXPECT_FALSE(here(0, 0));
  map.depth(cv::Rect(40, 20, 6, 6)) = 0;
  EXPECT_TRUE(here(39, 22));  // three of eight lack a depth
  map.depth(20, 37) = 0;
  EXPECT_FALSE(here(39, 22));  // four do
}

// A strip of cameras that look the same way, each seeing a part of its neighbours' ground.
struct Strip {
  Scene scene;
  std::vector<FusionView> views;
  std::vector<DepthMap> maps;

  PointCloud fused(const FuseOptions& options = {}) {
    return fuse(scene, views, {[this](std::size_t i) { return maps[i]; }, {}}, options);
  }

  // In how many images, `margin` pixels within their borders, the point lies.
  int cameras_that_see(const Eigen::Vector3d& point, double margin) const {
    int count = 0;
    for (const DepthMap& map : maps)
      std::visit(
          [&](const auto& camera) {
            const auto seen = camera.project(map.pose.to_camera(point));
            const double x = seen.pixel.x(), y = seen.pixel.y();
            count += seen.visible && x > margin && y > margin && x < map.width() - 1 - margin &&
                     y < map.height() - 1 - margin;
          },
          make_camera<double>(map.camera));
    return count;
  }
};

class FuseStrip : public testing::TestWithParam<bool> {
 protected:
  // A narrow lens: a depth changes by far less than the threshold from pixel to pixel.
  static CameraModel model() {
    CameraModel camera = test::dry_camera();
    camera.lens.fx = camera.lens.fy = 150;
    return GetParam() ? test::behind_port(camera) : camera;
  }

  static Strip strip() {
    constexpr std::size_t kCount = 5;
    std::vector<Pose> poses(kCount);
    for (std::size_t i = 0; i < kCount; ++i)
      poses[i].centre = {(GetParam() ? 0.16 : 0.22) * static_cast<double>(i),
                         0.02 * static_cast<double>(i % 2), 0};
    Strip result;
    result.scene = test::scene_of(model(), poses);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      result.maps.push_back(exact_map(world(), model(), poses[i]));
      result.views.push_back({i, {}, kCount});
      for (std::uint32_t k = 0; k < kCount; ++k)
        if (k != i) result.views.back().neighbours.push_back(k);
    }
    return result;
  }

  static AnalyticScene world() {
    AnalyticScene ground;
    ground.plane = {Eigen::Vector3d(0.05, -0.1, -1).normalized(), Eigen::Vector3d(0.4, 0, 1)};
    return ground;
  }
};
INSTANTIATE_TEST_SUITE_P(Cameras, FuseStrip, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

std::size_t views_of(const PointCloud& cloud, std::size_t point) {
  return cloud.view_begin[point + 1] - cloud.view_begin[point];
}

TEST_P(FuseStrip, TakesTwoViewsExactlyWhereTwoCamerasSee) {
  Strip strip = FuseStrip::strip();
  const PointCloud cloud = strip.fused();
  std::size_t of_two = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d point = cloud.positions[i].cast<double>();
    ASSERT_LT(world().distance(point), 1e-6);
    if (views_of(cloud, i) != 2) continue;
    ++of_two;
    // A point is a mean of pixels: its own image may lie a pixel beside theirs.
    EXPECT_LE(strip.cameras_that_see(point, 1.0), 2);
  }
  EXPECT_GT(of_two, 500u);

  FuseOptions three;
  three.two_where_two_see = false;
  const PointCloud without = strip.fused(three);
  for (std::size_t i = 0; i < without.size(); ++i) ASSERT_GE(views_of(without, i), 3u);
}

TEST_P(FuseStrip, CoversTheGroundThatTwoCamerasSee) {
  Strip strip = FuseStrip::strip();
  const PointCloud cloud = strip.fused();
  std::size_t seen = 0, covered = 0;
  for (double x = -0.25; x < 1.15; x += 0.01)
    for (double y = -0.2; y < 0.2; y += 0.01) {
      const Eigen::Vector3d point = world().plane.projection({x, y, 1});
      // Within three pixels of a border maps hold too little around a pixel.
      if (strip.cameras_that_see(point, 3) != 2 || strip.cameras_that_see(point, 0) != 2) continue;
      ++seen;
      constexpr double kTwoPixels = 0.015;
      covered += std::ranges::any_of(cloud.positions, [&](const Eigen::Vector3f& p) {
        return (p.cast<double>() - point).norm() < kTwoPixels;
      });
    }
  ASSERT_GT(seen, 200u);
  EXPECT_EQ(covered, seen);
}

// A third camera that should see the ground and has no depth there does not confirm it.
TEST_P(FuseStrip, WantsThreeWhereAThirdCameraShouldSee) {
  Strip strip = FuseStrip::strip();
  const PointCloud whole = strip.fused();
  const auto of_two = [](const PointCloud& cloud) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) count += views_of(cloud, i) == 2;
    return count;
  };
  strip.maps[2].depth = 0.0f;
  const PointCloud cloud = strip.fused();
  EXPECT_LT(cloud.size(), whole.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (views_of(cloud, i) != 2) continue;
    EXPECT_LE(strip.cameras_that_see(cloud.positions[i].cast<double>(), 1.0), 2);
  }
  EXPECT_LT(of_two(cloud), of_two(whole));
}

// Pixels of two maps that agree on a wrong depth, each alone.
TEST_P(FuseStrip, DoesNotBelieveTwoLonePixels) {
  Strip strip = FuseStrip::strip();
  const auto last = make_camera<double>(strip.maps[4].camera);
  int planted = 0;
  for (int y = 12; y < 60; y += 6)
    for (int x = 12; x < 90; x += 6) {
      DepthMap &from = strip.maps[3], &to = strip.maps[4];
      const float wrong = 0.9f * from.depth(y, x);
      std::visit(
          [&](const auto& camera) {
            const Eigen::Vector3d point =
                from.pose.to_world(camera.ray({double(x), double(y)}).at(double(wrong)));
            const auto seen = camera.project(to.pose.to_camera(point));
            const int u = static_cast<int>(std::lround(seen.pixel.x()));
            const int v = static_cast<int>(std::lround(seen.pixel.y()));
            if (!seen.visible || u < 6 || v < 6 || u >= to.width() - 6 || v >= to.height() - 6)
              return;
            const auto ray = camera.ray(seen.pixel);
            from.depth(y, x) = wrong;
            to.depth(v, u) = static_cast<float>((to.pose.to_camera(point) - ray.origin).norm());
            ++planted;
          },
          last);
    }
  ASSERT_GT(planted, 10);
  const PointCloud cloud = strip.fused();
  for (const Eigen::Vector3f& p : cloud.positions)
    ASSERT_LT(world().distance(p.cast<double>()), 1e-6);

  FuseOptions two;
  two.min_views = 2;
  const PointCloud believed = strip.fused(two);
  EXPECT_TRUE(std::ranges::any_of(believed.positions, [&](const Eigen::Vector3f& p) {
    return world().distance(p.cast<double>()) > 0.05;
  }));
}

}  // namespace
}  // namespace axial::cloud
