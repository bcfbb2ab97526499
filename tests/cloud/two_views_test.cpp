// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/two_views.h"

#include <gtest/gtest.h>

#include <cstring>

#include "cloud/fuse.h"
#include "support/analytic_scene.h"

namespace axial::cloud {
namespace {

using test::AnalyticScene;

TEST(UndisputedWitness, IsTheFirstNeighbourThatShowsThePoint) {
  const Answer unseen, differs = Answer::differs(), joins = Answer::joins(7),
                       through = Answer::contradicts(7);
  const auto witness = [](const std::vector<Answer>& of_neighbours) {
    std::vector<std::vector<Answer>> answers;
    for (const Answer answer : of_neighbours) answers.push_back({Answer(), answer});
    return undisputed_witness(answers, 1);
  };
  EXPECT_EQ(witness({}), std::nullopt);
  EXPECT_EQ(witness({unseen, unseen}), std::nullopt);
  EXPECT_EQ(witness({unseen, joins, unseen}), 1u);
  EXPECT_EQ(witness({unseen, joins, joins}), 1u);
  for (const Answer other : {differs, through}) {
    EXPECT_EQ(witness({other}), std::nullopt);
    EXPECT_EQ(witness({other, joins}), std::nullopt);
    EXPECT_EQ(witness({joins, other}), std::nullopt);
    EXPECT_EQ(witness({joins, joins, other}), std::nullopt);
  }
}

// A slanted plane, seen by a camera with large pixels: between pixels at a distance of two, the
// depth along the ray changes by up to 2 / 75 * tan(60 degrees) = 4.6 %.
class SurfaceAroundPixel : public testing::TestWithParam<bool> {
 protected:
  static CameraModel model() {
    return GetParam() ? test::behind_port(test::dry_camera()) : test::dry_camera();
  }

  static DepthMap plane(double slant) {
    AnalyticScene world;
    world.plane = {Eigen::Vector3d(std::sin(slant), 0, -std::cos(slant)), Eigen::Vector3d(0, 0, 1)};
    return exact_map(world, model(), {});
  }

  static bool around(const DepthMap& map, int x, int y, float max_distance = 0.0025f) {
    const FusionMap fusion_map = make_fusion_map(map, {});
    return SurfacePieces(fusion_map, max_distance)
        .around(static_cast<std::uint32_t>(y * map.width() + x));
  }

  static bool near_border(const DepthMap& map, int x, int y) {
    return x < 2 || y < 2 || x >= map.width() - 2 || y >= map.height() - 2;
  }
};
INSTANTIATE_TEST_SUITE_P(Cameras, SurfaceAroundPixel, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

TEST_P(SurfaceAroundPixel, IsSeenHoweverThePlaneSlants) {
  for (const double slant : {0.0, 0.5, 1.0}) {
    const DepthMap map = plane(slant);
    const FusionMap fusion_map = make_fusion_map(map, {});
    const SurfacePieces pieces(fusion_map, 1e-5f);  // allows for the rounding of floats
    for (int y = 2; y < map.height() - 2; ++y)
      for (int x = 2; x < map.width() - 2; ++x)
        ASSERT_TRUE(pieces.around(static_cast<std::uint32_t>(y * map.width() + x)))
            << slant << ' ' << x << ' ' << y;
  }
}

TEST_P(SurfaceAroundPixel, HoldsOnBordersAndNotInCorners) {
  const DepthMap map = plane(0.5);
  for (const int x : {0, 1, map.width() - 1}) EXPECT_TRUE(around(map, x, 30)) << x;
  for (const int y : {0, 1, map.height() - 1}) EXPECT_TRUE(around(map, 30, y)) << y;
  EXPECT_FALSE(around(map, 0, 0));
}

TEST_P(SurfaceAroundPixel, IsNotSeenAroundAPixelBesideIt) {
  DepthMap map = plane(0.5);
  map.depth(20, 20) *= 1.05f;
  EXPECT_FALSE(around(map, 20, 20));
  EXPECT_TRUE(around(map, 22, 22));  // one of eight is off its plane
}

TEST_P(SurfaceAroundPixel, MayHaveHoles) {
  DepthMap map = plane(0.5);
  map.depth(cv::Rect(40, 20, 6, 6)) = 0;
  map.depth(20, 37) = 0;
  EXPECT_TRUE(around(map, 39, 22));  // four of eight lack a depth
  map.depth(24, 37) = 0;
  EXPECT_FALSE(around(map, 39, 22));  // five of eight lack a depth
}

TEST_P(SurfaceAroundPixel, IsUnknownWithoutTheNormal) {
  DepthMap map = plane(0.5);
  map.normal(30, 30) = cv::Vec3f(0, 0, 0);
  EXPECT_FALSE(around(map, 30, 30));
  EXPECT_TRUE(around(map, 32, 32));
}

// Beside a straight depth edge, five of eight pixels are on the surface.
TEST_P(SurfaceAroundPixel, EndsAtCornersOfDepthEdges) {
  DepthMap map = plane(0.5);
  map.depth(cv::Rect(40, 20, map.width() - 40, map.height() - 20)) *= 1.05f;
  EXPECT_FALSE(around(map, 40, 20));
  EXPECT_FALSE(around(map, 41, 21));
  EXPECT_TRUE(around(map, 42, 22));
  for (const int x : {39, 40}) EXPECT_TRUE(around(map, x, 40)) << x;
}

TEST_P(SurfaceAroundPixel, IsNotSeenOnStripsOfTwoPixels) {
  DepthMap map = plane(0.5);
  map.depth(cv::Rect(40, 0, 2, map.height())) *= 0.95f;
  for (const int x : {40, 41}) EXPECT_FALSE(around(map, x, 30)) << x;
  EXPECT_TRUE(around(map, 39, 30));
}

// A row of cameras with parallel axes whose images overlap those of their neighbours.
struct Strip {
  Scene scene;
  std::vector<FusionView> views;
  std::vector<DepthMap> maps;

  PointCloud fused(const FuseOptions& options = {}) {
    return fuse(scene, views, {[this](std::size_t i) { return maps[i]; }, {}}, options);
  }

  // The number of images that contain the point at least `margin` pixels from their borders.
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
  // The lens is narrow, so that depths of neighbouring pixels differ by far less than the
  // threshold.
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

TEST_P(FuseStrip, TakesTwoViewsWhereTwoCamerasSee) {
  Strip strip = FuseStrip::strip();
  const PointCloud cloud = strip.fused();
  const auto in_two = [&](std::size_t i) {
    return strip.cameras_that_see(cloud.positions[i].cast<double>(), 0) == 2;
  };
  std::size_t of_two = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT(world().distance(cloud.positions[i].cast<double>()), 1e-6);
    of_two += views_of(cloud, i) == 2 && in_two(i);
  }
  EXPECT_GT(of_two, 500u);

  FuseOptions three;
  three.two_if_undisputed = false;
  const PointCloud without = strip.fused(three);
  for (std::size_t i = 0; i < without.size(); ++i) ASSERT_GE(views_of(without, i), 3u);
}

// If all maps agree, a pixel stays without a point only if all pixels that agree with it belong to
// points already. So there are nearly as many points as with min_views = 2, and more than with 3.
TEST_P(FuseStrip, CountsMapsThatAgreeButAreUsed) {
  Strip strip = FuseStrip::strip();
  const std::size_t found = strip.fused().size();
  FuseOptions everywhere;
  everywhere.min_views = 2;
  EXPECT_GT(static_cast<double>(found), 0.95 * static_cast<double>(strip.fused(everywhere).size()));
  everywhere.min_views = 3;
  everywhere.two_if_undisputed = false;
  EXPECT_GT(static_cast<double>(found), 1.3 * static_cast<double>(strip.fused(everywhere).size()));
}

TEST_P(FuseStrip, CoversTheGroundThatTwoCamerasSee) {
  Strip strip = FuseStrip::strip();
  const PointCloud cloud = strip.fused();
  std::size_t seen = 0, covered = 0;
  for (double x = -0.25; x < 1.15; x += 0.01)
    for (double y = -0.2; y < 0.2; y += 0.01) {
      const Eigen::Vector3d point = world().plane.projection({x, y, 1});
      // A pixel within three pixels of a border has too few surrounding pixels.
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

std::size_t points_of_two(const PointCloud& cloud) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) count += views_of(cloud, i) == 2;
  return count;
}

bool same_bytes(const PointCloud& a, const PointCloud& b) {
  return a.size() == b.size() && a.view_images == b.view_images &&
         std::memcmp(a.positions.data(), b.positions.data(), a.size() * sizeof(a.positions[0])) ==
             0;
}

TEST_P(FuseStrip, HearsNothingFromAMapWithoutDepths) {
  Strip strip = FuseStrip::strip();
  strip.maps[2].depth = 0.0f;
  const PointCloud cloud = strip.fused();
  strip.views.erase(strip.views.begin() + 2);
  const PointCloud without = strip.fused();
  EXPECT_GT(points_of_two(without), 500u);
  EXPECT_TRUE(same_bytes(cloud, without));
}

// A third map either sees through the ground or has other normals there.
TEST_P(FuseStrip, WantsThreeWhereAThirdMapDisagrees) {
  const std::size_t whole = points_of_two(strip().fused());
  for (const bool farther : {false, true}) {
    Strip strip = FuseStrip::strip();
    if (farther)
      strip.maps[2].depth *= 1.2;
    else
      strip.maps[2].normal = cv::Vec3f(0, 1, 0);
    const PointCloud cloud = strip.fused();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d point = cloud.positions[i].cast<double>();
      if (views_of(cloud, i) != 2 || world().distance(point) > 1e-3) continue;
      EXPECT_LE(strip.cameras_that_see(point, 1.0), 2);
    }
    EXPECT_LT(points_of_two(cloud), whole);
  }
}

// Isolated pixels of two maps agree on a wrong depth.
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
