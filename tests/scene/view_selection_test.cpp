// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/view_selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "io/openmvs/mvs.h"
#include "scene/camera_model.h"
#include "support/analytic_scene.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

// A grid of points on a slope, 0.8 to 1.2 m in front of a circle of cameras that all see the
// points.
Scene make_scene(const CameraModel& model, std::size_t count = 5, double radius = 0.2) {
  Scene scene = test::scene_of(model, test::circle_of_poses(count, radius));
  for (int i = -8; i <= 8; ++i) {
    for (int k = -8; k <= 8; ++k) {
      SparsePoint point;
      const float x = 0.03f * static_cast<float>(i), y = 0.03f * static_cast<float>(k);
      point.position = {x, y, 1.0f + 0.4f * x - 0.3f * y};
      for (std::uint32_t v = 0; v < count; ++v) point.views.push_back({v, 0});
      scene.points.push_back(point);
    }
  }
  return scene;
}

TEST(ScoreNeighbours, ReproducesStoredScores) {
  const fs::path folder = fs::path(AXIAL_SOURCE_DIR) / "../shared/data/openmvs-files";
  const fs::path file = folder / "scene_dense_v7.mvs";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const Scene stored = io::read_mvs(file, folder);
  Scene scene = stored;
  score_neighbours(scene);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < stored.images.size(); ++i) {
    const SceneImage &expected = stored.images[i], &actual = scene.images[i];
    EXPECT_NEAR(actual.average_depth / expected.average_depth, 1, 1e-5);
    ASSERT_EQ(actual.neighbours.size(), expected.neighbours.size());
    for (std::size_t k = 0; k < expected.neighbours.size(); ++k) {
      const ViewScore &a = actual.neighbours[k], &e = expected.neighbours[k];
      EXPECT_EQ(a.image, e.image);
      EXPECT_EQ(a.points, e.points);
      // 1e-5 is the precision with which the stored floats were accumulated.
      EXPECT_NEAR(a.scale / e.scale, 1, 1e-5);
      EXPECT_NEAR(a.angle / e.angle, 1, 1e-5);
      EXPECT_EQ(a.area, e.area);
      EXPECT_NEAR(a.score / e.score, 1, 1e-5);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 110u);
}

RC_GTEST_PROP(ScoreNeighbours, APortOfAirChangesNothing, ()) {
  const double radius = *rc::gen::inRange(5, 40) / 100.0;
  CameraModel air = test::behind_port(test::dry_camera(), 1, 1);
  auto& port_of_air = std::get<refractive::FlatPort<double>>(*air.port);
  port_of_air.distance = *rc::gen::inRange(0, 100) / 1000.0;
  port_of_air.thickness = *rc::gen::inRange(0, 50) / 1000.0;
  port_of_air.normal =
      Eigen::Vector3d(*rc::gen::inRange(-20, 20), *rc::gen::inRange(-20, 20), 100).normalized();
  Scene dry = make_scene(test::dry_camera(), 4, radius);
  Scene port = make_scene(air, 4, radius);
  const auto dry_views = score_neighbours(dry);
  const auto port_views = score_neighbours(port);
  for (std::size_t i = 0; i < dry.images.size(); ++i) {
    RC_ASSERT(dry_views[i].init_points == port_views[i].init_points);
    RC_ASSERT(std::abs(dry_views[i].min_depth - port_views[i].min_depth) < 1e-6f);
    RC_ASSERT(dry.images[i].neighbours.size() == port.images[i].neighbours.size());
    for (std::size_t k = 0; k < dry.images[i].neighbours.size(); ++k) {
      const ViewScore &a = dry.images[i].neighbours[k], &b = port.images[i].neighbours[k];
      RC_ASSERT(a.points == b.points);
      // Tolerances for the rounding of projections and of directions, which are stored as floats.
      RC_ASSERT(std::abs(a.scale - b.scale) < 1e-5f);
      RC_ASSERT(std::abs(a.angle - b.angle) < 1e-5f);
      RC_ASSERT(std::abs(a.score / b.score - 1) < 2e-2f);  // a point on a cell's border may move
    }
  }
}

// Compares the angles for cameras behind a port with the angles between the rays of the pixels.
TEST(ScoreNeighbours, MeasuresAnglesInTheWater) {
  const CameraModel model = test::behind_port(test::dry_camera());
  Scene scene = make_scene(model, 3);
  scene.points.resize(1);
  ViewSelectionOptions options;
  options.min_shared_points = 1;
  score_neighbours(scene, options);
  const Eigen::Vector3d X = scene.points[0].position.cast<double>();
  const auto camera = make_camera<double>(model);
  const auto direction = [&](std::size_t i) {
    const Pose& pose = scene.images[i].pose;
    return std::visit(
        [&](const auto& c) -> Eigen::Vector3d {
          const auto ray = c.ray(c.project(pose.to_camera(X)).pixel);
          return (X - pose.to_world(ray.origin)).normalized();
        },
        camera);
  };
  ASSERT_FALSE(scene.images[0].neighbours.empty());
  for (const ViewScore& view : scene.images[0].neighbours) {
    // 1e-6, because directions are stored as floats.
    EXPECT_NEAR(view.angle, std::acos(direction(0).dot(direction(view.image))), 1e-6);
  }
}

TEST(ScoreNeighbours, CountsRepeatedViewsOnce) {
  Scene once = make_scene(test::dry_camera()), twice = once;
  for (SparsePoint& point : twice.points) point.views.insert(point.views.begin(), {0, 0});
  score_neighbours(once);
  score_neighbours(twice);
  for (std::size_t i = 0; i < once.images.size(); ++i) {
    EXPECT_EQ(once.images[i].neighbours[0].points, twice.images[i].neighbours[0].points);
    EXPECT_EQ(once.images[i].neighbours[0].score, twice.images[i].neighbours[0].score);
  }
}

TEST(ScoreNeighbours, IgnoresWhatACameraCannotSee) {
  Scene scene = make_scene(test::behind_port(test::dry_camera()));
  const Scene clean = scene;
  SparsePoint behind = scene.points[0], aside = behind, broken = behind;
  behind.position = {0, 0, -1};
  aside.position = {30, 0, 1};
  broken.position.x() = std::numeric_limits<float>::quiet_NaN();
  scene.points.insert(scene.points.end(), {behind, aside, broken});
  Scene expected = clean;
  score_neighbours(scene);
  score_neighbours(expected);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    EXPECT_EQ(scene.images[i].average_depth, expected.images[i].average_depth);
    EXPECT_EQ(scene.images[i].neighbours[0].score, expected.images[i].neighbours[0].score);
  }
}

TEST(ScoreNeighbours, WeighsPointsOutsideTheRegionLess) {
  Scene scene = make_scene(test::dry_camera());
  score_neighbours(scene);
  const float everywhere = scene.images[0].neighbours[0].score;
  scene.region = OrientedBox{};  // has no extent, so that all points are outside
  score_neighbours(scene);
  EXPECT_NEAR(scene.images[0].neighbours[0].score, 0.7f * everywhere, 1e-4f * everywhere);
}

TEST(ScoreNeighbours, SaysWhyAnImageCannotBeUsed) {
  Scene scene = make_scene(test::dry_camera());
  scene.images[1].calibrated = false;
  for (SparsePoint& point : scene.points)
    std::erase_if(point.views, [](auto v) { return v.image == 2; });
  const auto views = score_neighbours(scene);
  EXPECT_TRUE(views[0].usable());
  EXPECT_THAT(views[1].problem, testing::HasSubstr("calibrated"));
  EXPECT_THAT(views[2].problem, testing::HasSubstr("sparse points"));
  for (const ViewScore& view : scene.images[0].neighbours) EXPECT_GT(view.image, 2u);
}

TEST(ScoreNeighbours, SaysWhereThePointsOfAnUnusableImageLie) {
  // The first camera looks away from all points.
  Scene scene = make_scene(test::behind_port(test::dry_camera()));
  scene.images[0].pose.rotation =
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()) * scene.images[0].pose.rotation;
  EXPECT_EQ(score_neighbours(scene)[0].problem,
            "it sees only 0 sparse points (289 more do not count: 289 behind the camera)");

  scene = make_scene(test::dry_camera());
  for (SparsePoint& point : scene.points)
    std::erase_if(point.views, [](auto v) { return v.image == 2; });
  for (SparsePoint alone : std::vector(scene.points)) {
    alone.views = {{2, 0}};
    scene.points.push_back(alone);
  }
  EXPECT_EQ(score_neighbours(scene)[2].problem,
            "it sees only 0 sparse points (289 more do not count: 289 seen by no other image)");
}

// Any number of neighbours with one reason for rejection each. Every neighbour must be counted
// once, under its own reason.
RC_GTEST_PROP(WhyNoSourceView, CountsEachNeighbourOnce, ()) {
  const ViewSelectionOptions options;
  const auto good = [] {
    ViewScore view;
    view.points = 5;
    view.scale = 1;
    view.angle = 0.2f;
    view.area = 0.5f;
    view.score = 1;
    return view;
  }();
  ViewScore narrow = good, wide = good, scaled = good, small = good;
  narrow.angle = 0.01f;
  wide.angle = 1.5f;
  scaled.scale = 5;
  small.area = 0.01f;
  const std::vector<std::pair<ViewScore, std::string>> kinds = {
      {good, "sharing too few points"},
      {narrow, "seen under too small an angle"},
      {wide, "seen under too large an angle"},
      {scaled, "of too different a scale"},
      {small, "sharing too small an area"}};
  const auto counts = *rc::gen::container<std::vector<std::size_t>>(
      kinds.size(), rc::gen::inRange<std::size_t>(0, 4));
  std::vector<ViewScore> neighbours;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    neighbours.insert(neighbours.end(), counts[kind], kinds[kind].first);
  RC_ASSERT(choose_source_views(neighbours, 5, options).empty());
  const std::string said = why_no_source_view(neighbours, options);
  RC_ASSERT(
      said.starts_with(fmt::format("no suitable source view: {} images have", neighbours.size())));
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const std::string part = fmt::format(" {} {}", counts[kind], kinds[kind].second);
    RC_ASSERT((said.find(part) != std::string::npos) == (counts[kind] > 0));
  }
}

// Tests the bounds of the number of neighbours. The bound of count_neighbours() is exact if every
// camera can have made its observations.
RC_GTEST_PROP(CountNeighbours, IsWhatScoringFinds, ()) {
  Scene scene = test::scene_of(test::dry_camera(), test::circle_of_poses(7, 0.2));
  // The bits of a track are the images that see the point.
  const auto tracks = *rc::gen::container<std::vector<unsigned>>(rc::gen::inRange(0u, 128u));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    SparsePoint point;
    point.position = {0.01f * static_cast<float>(i % 5), 0.01f * static_cast<float>(i % 3), 1};
    for (std::uint32_t image = 0; image < 7; ++image)
      if (tracks[i] >> image & 1) point.views.push_back({image, 0});
    scene.points.push_back(point);
  }
  const std::uint64_t counted = count_neighbours(scene);
  RC_ASSERT(counted <= scoring_size(scene).neighbours);
  score_neighbours(scene);
  std::uint64_t found = 0;
  for (const SceneImage& image : scene.images) found += image.neighbours.size();
  RC_ASSERT(counted == found);
}

TEST(ScoreNeighbours, RefusesViewsOfImagesThatDoNotExist) {
  Scene scene = make_scene(test::dry_camera());
  scene.points[7].views.push_back({5, 0});
  try {
    score_neighbours(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("points[7]"));
  }
}

TEST(ScoreNeighbours, GivesTheSameForAnyNumberOfThreads) {
  Scene one = make_scene(test::behind_port(test::dry_camera())), two = one;
  {
    const ThreadLimit limit(1);
    score_neighbours(one);
  }
  {
    const ThreadLimit limit(2);
    score_neighbours(two);
  }
  for (std::size_t i = 0; i < one.images.size(); ++i) {
    const auto &a = one.images[i].neighbours, &b = two.images[i].neighbours;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(ViewScore)), 0);
  }
}

ViewScore good(std::uint32_t image, float score) {
  return {image, 100, 1.0f, 0.2f, 0.5f, score};
}

TEST(FilterNeighbours, DropsUnsuitableOnesFromTheWorstWhileEnoughRemain) {
  std::vector<ViewScore> list;
  for (std::uint32_t i = 0; i < 11; ++i) list.push_back(good(i, 100.0f - static_cast<float>(i)));
  list[0].angle = 0.01f;
  list[5].area = 0.01f;
  list[7].scale = 4.0f;
  const auto filtered = filter_neighbours(list);
  // Of 11 neighbours 9 must remain. 7 and 5 are removed; 0 stays in spite of its angle.
  ASSERT_EQ(filtered.size(), 9u);
  EXPECT_EQ(filtered[0].image, 0u);
  for (const ViewScore& view : filtered) EXPECT_TRUE(view.image != 5 && view.image != 7);
}

TEST(FilterNeighbours, KeepsTheBestTwelve) {
  std::vector<ViewScore> list;
  for (std::uint32_t i = 0; i < 20; ++i) list.push_back(good(i, 100.0f - static_cast<float>(i)));
  const auto filtered = filter_neighbours(list);
  ASSERT_EQ(filtered.size(), 12u);
  EXPECT_EQ(filtered.back().image, 11u);
}

TEST(ChooseSourceViews, TakesTheFirstWithEnoughScore) {
  const std::vector<ViewScore> list{good(4, 1000), good(2, 500), good(7, 29), good(9, 20)};
  EXPECT_EQ(choose_source_views(list, 1).size(), 1u);
  EXPECT_EQ(choose_source_views(list, 5).size(), 2u);  // 3 % of 1000 is 30
  EXPECT_EQ(choose_source_views(list, 0).size(), 2u);
  EXPECT_TRUE(choose_source_views({good(1, 1.5f)}, 5).empty());
  EXPECT_TRUE(choose_source_views({}, 5).empty());
}

}  // namespace
}  // namespace axial
