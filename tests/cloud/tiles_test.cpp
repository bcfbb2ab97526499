// SPDX-License-Identifier: GPL-3.0-or-later
// The division of space into tiles, and fusion tile by tile against fusion in one piece.
#include "cloud/tiles.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <string>

#include "base/parallel.h"
#include "cloud/fusion_fixture.h"
#include "drawn.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

// Points of a flat scene, with a few that are far away.
std::vector<Eigen::Vector3f> random_points(std::mt19937& random, std::size_t count) {
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    const float reach = i % 20 == 0 ? 100.0f : 1.0f;
    points.emplace_back(7 * normal(random), reach * 3 * normal(random), reach * normal(random));
  }
  return points;
}

std::size_t tiles_with(const std::vector<Tile>& tiles, const Eigen::Vector3d& place) {
  return static_cast<std::size_t>(
      std::ranges::count_if(tiles, [&](const Tile& tile) { return tile.contains(place); }));
}

RC_GTEST_PROP(Tiles, EachPlaceBelongsToOneTile, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const auto count = *rc::gen::inRange<std::size_t>(1, 40);
  const auto points = random_points(random, *rc::gen::inRange<std::size_t>(0, 300));
  const auto tiles = make_tiles(points, count, random_rotation(random));
  RC_ASSERT(tiles.size() == count);
  std::uniform_real_distribution<double> uniform(-300, 300);
  for (const Eigen::Vector3f& point : points)  // among them are points on the borders of tiles
    RC_ASSERT(tiles_with(tiles, point.cast<double>()) == 1u);
  for (int i = 0; i < 100; ++i)
    RC_ASSERT(tiles_with(tiles, {uniform(random), uniform(random), uniform(random)}) == 1u);
}

RC_GTEST_PROP(Tiles, HaveTheSameNumberOfPoints, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const auto count = *rc::gen::inRange<std::size_t>(1, 40);
  const auto points = random_points(random, *rc::gen::inRange<std::size_t>(count, 900));
  std::vector<std::ptrdiff_t> numbers;
  for (const Tile& tile : make_tiles(points, count, random_rotation(random)))
    numbers.push_back(std::ranges::count_if(
        points, [&](const Eigen::Vector3f& p) { return tile.contains(p.cast<double>()); }));
  const auto [least, most] = std::ranges::minmax(numbers);
  RC_ASSERT(most - least <= 2);
}

TEST(Tiles, CutAcrossTheLongestExtentOfMostPoints) {
  std::mt19937 random(1);
  const auto tiles = make_tiles(random_points(random, 500), 2, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(tiles[0].high.x(), 0, 1);  // the far points extend farther in y and z
  EXPECT_EQ(tiles[0].high.y(), Tile::kInfinity);
}

TEST(Tiles, OfPointsInOnePlaceStillCoverSpace) {
  const std::vector<Eigen::Vector3f> points(9, Eigen::Vector3f(1, 2, 3));
  const auto tiles = make_tiles(points, 5, Eigen::Matrix3d::Identity());
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, 5, 5)})
    EXPECT_EQ(tiles_with(tiles, place), 1u);
}

// Views of a sphere in front of a plane. Each depth has an error, so that many pixels join other
// points or none.
Fixture noisy_fixture(const CameraModel& model) {
  AnalyticScene world;
  world.sphere_centre = {0, 0, 0.75};
  world.sphere_radius = 0.12;
  Fixture fixture = make_fixture(world, model, 8);
  std::mt19937 random(3);
  std::normal_distribution<float> error(0, 0.003f);
  for (std::uint32_t i = 0; i < 8; ++i) {
    fixture.views[i].rank = (i * 5) % 8;
    for (float& depth : fixture.maps[i].depth) depth *= 1 + error(random);
  }
  return fixture;
}

// Four tiles that cut through the sphere and the plane.
std::vector<Tile> four_tiles() {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(-0.3f, 0.3f);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(uniform(random), uniform(random), 0.9f);
  return make_tiles(points, 4, Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).matrix());
}

PointCloud fuse_part(Fixture& fixture, const FusionPart& part, FuseOptions options = {}) {
  options.part = part;
  return run(fixture, options);
}

PointCloud fuse_tiles(Fixture& fixture, double margin) {
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  for (const Tile& tile : four_tiles()) {
    const PointCloud points = fuse_part(fixture, {tile, grown(tile, margin), {}});
    EXPECT_GT(points.size(), 130u);
    for (const Eigen::Vector3f& point : points.positions)
      EXPECT_TRUE(tile.contains(point.cast<double>()));
    append(cloud, points);
  }
  return cloud;
}

// One text for each point with the bytes of all of its attributes, sorted.
std::vector<std::string> sorted_points(const PointCloud& cloud) {
  std::vector<std::string> points;
  const auto bytes = [](const auto& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::string text = bytes(cloud.positions[i]) + bytes(cloud.normals[i]);
    for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k)
      text += bytes(cloud.view_images[k]) + bytes(cloud.view_weights[k]);
    points.push_back(text);
  }
  std::ranges::sort(points);
  return points;
}

// The number of points that only one of the clouds has.
std::size_t differing(const PointCloud& a, const PointCloud& b) {
  std::vector<std::string> only;
  std::ranges::set_symmetric_difference(sorted_points(a), sorted_points(b),
                                        std::back_inserter(only));
  return only.size();
}

class FuseTiles : public FuseWithCamera {
 protected:
  // All cases fuse the same maps, of 64 x 48 pixels, and none changes them.
  static Fixture fixture() { return shared().first; }
  // All points, fused in one piece.
  static const PointCloud& whole() { return shared().second; }

 private:
  static const std::pair<Fixture, PointCloud>& shared() {
    static std::map<bool, std::pair<Fixture, PointCloud>> made;
    if (!made.contains(GetParam())) {
      Fixture fixture = noisy_fixture(model().resized(64, 48));
      const PointCloud whole = run(fixture);
      made[GetParam()] = {fixture, whole};
    }
    return made[GetParam()];
  }
};
INSTANTIATE_TEST_SUITE_P(Cameras, FuseTiles, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

TEST_P(FuseTiles, WithAnInfiniteMarginGiveThePointsOfOnePiece) {
  Fixture fixture = FuseTiles::fixture();
  EXPECT_GT(whole().size(), 1300u);
  EXPECT_EQ(differing(whole(), fuse_tiles(fixture, Tile::kInfinity)), 0u);
}

TEST_P(FuseTiles, DifferFromOnePieceOnlyNearTheirBorders) {
  Fixture fixture = FuseTiles::fixture();
  // In pixels (2 cm): none, a third, three.
  const std::size_t without = differing(whole(), fuse_tiles(fixture, 0));
  const std::size_t near = differing(whole(), fuse_tiles(fixture, 0.0075));
  const std::size_t far = differing(whole(), fuse_tiles(fixture, 0.06));
  EXPECT_GT(without, whole().size() / 100);
  EXPECT_LT(near, without / 2);
  EXPECT_LT(far, whole().size() / 200);
}

TEST_P(FuseTiles, GiveTheSameBytesForAnyThreadsMapsAndUnseenViews) {
  Fixture fixture = FuseTiles::fixture();
  const Tile tile = four_tiles()[1], reach = grown(tile, 0.02);
  const PointCloud expected = fuse_part(fixture, {tile, reach, {}});
  const ThreadLimit limit(2);
  FusionPart part{tile, reach, {}};
  for (const DepthMap& map : fixture.maps)
    part.seen_by.push_back(boxes_seen(map, std::span(&reach, 1))[0]);
  FuseOptions options;
  options.max_maps = 1;
  EXPECT_TRUE(same_bytes(fuse_part(fixture, part, options), expected));
  const ThreadLimit one(1);
  EXPECT_TRUE(same_bytes(fuse_part(fixture, part), expected));
}

// The points of the map's pixels [world].
std::vector<Eigen::Vector3d> points_of(const DepthMap& map) {
  std::vector<Eigen::Vector3d> points;
  std::visit(
      [&](const auto& camera) {
        for (int y = 0; y < map.height(); ++y)
          for (int x = 0; x < map.width(); ++x)
            if (map.depth(y, x) > 0)
              points.push_back(
                  map.pose.to_world(camera.ray({x, y}).at(static_cast<double>(map.depth(y, x)))));
      },
      make_camera<double>(map.camera));
  return points;
}

TEST_P(FuseTiles, AMapSeesTheBoxesThatHoldItsPoints) {
  const DepthMap map = fixture().maps[2];
  const std::vector<Eigen::Vector3d> points = points_of(map);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5), size(0.001, 0.2);
  std::vector<Tile> boxes(300);
  const Eigen::Matrix3d rotation = random_rotation(random);
  for (std::size_t i = 0; i < boxes.size(); ++i) {  // every second one near the surface
    Tile& box = boxes[i];
    const Eigen::Vector3d place(uniform(random), uniform(random), 1 + uniform(random));
    box.rotation = rotation;
    box.low = rotation * (i % 2 == 0 ? place : points[i * 7919 % points.size()]);
    if (i % 2 == 1) box.low.array() -= 0.1;
    box.high = box.low + axial::test::drawn<3>(size, random);
  }
  const std::vector<bool> seen = boxes_seen(map, boxes);
  int inside = 0, missed = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto holds = [&](const Tile& box) {
      return std::ranges::any_of(points, [&](const auto& point) { return box.contains(point); });
    };
    inside += holds(boxes[i]) ? 1 : 0;
    EXPECT_TRUE(seen[i] || !holds(boxes[i]));
    // The points of a block of 16 px are less than 0.75 m apart.
    if (holds(grown(boxes[i], 0.75))) continue;
    EXPECT_FALSE(seen[i]);
    ++missed;
  }
  EXPECT_GT(inside, 20);
  EXPECT_GT(missed, 20);
}

TEST(FuseTilesOfARing, LoadOnlyTheMapsOfTheViewsThatSeeThem) {
  Fixture fixture = make_fixture({}, test::dry_camera(), 8);
  for (std::uint32_t i = 0; i < 8; ++i) fixture.views[i].neighbours = {(i + 1) % 8, (i + 2) % 8};
  FusionPart part{{}, {}, std::vector<bool>(8, false)};
  part.seen_by[3] = true;
  EXPECT_GT(fuse_part(fixture, part).size(), 100u);
  EXPECT_EQ(fixture.loads, (std::map<std::size_t, int>{{3, 1}, {4, 1}, {5, 1}}));
  EXPECT_EQ(views_needed(fixture.views, part), 3u);
  part.seen_by[4] = true;
  EXPECT_EQ(views_needed(fixture.views, part), 4u);
  fixture.views.erase(fixture.views.begin() + 5);  // is a neighbour without a map
  part.seen_by.pop_back();
  EXPECT_EQ(views_needed(fixture.views, part), 3u);
}

}  // namespace
}  // namespace axial::cloud
