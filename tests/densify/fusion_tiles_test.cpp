// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds that are fused tile by tile, by one run or by several.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/program/tiling.h"
#include "densify/floor_fixture.h"
#include "densify/memory_plan.h"
#include "densify/tiles.h"
#include "io/ply/ply.h"
#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class FusionTiles : public FloorTest {
 protected:
  FusionTiles() {
    options_.matching.iterations = 1;
    options_.matching.geometric_iterations = 1;
  }

  std::string cloud() const {
    return read_file(fs::path(options_.output.scene).replace_extension(".ply"));
  }

  // Runs with other settings and returns the cloud.
  std::string cloud_in(std::size_t tiles, unsigned threads = 0) {
    Options options = options_;
    options.fusion.tiles = tiles;
    const ThreadLimit limit(threads);
    densify(options, {}, events_.context);
    return cloud();
  }

  Options with_tile(std::size_t tile, std::size_t tiles) const {
    Options options = options_;
    options.job = TileJob{tile};
    options.fusion.tiles = tiles;
    return options;
  }

  fs::path tile_path(std::size_t tile, std::size_t tiles) const {
    return tile_file(options_.output.scene, tile, tiles, ".ply");
  }

  std::size_t tile_files() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(options_.survey.files.working_folder))
      count += entry.path().filename().string().find(".tile") != std::string::npos ? 1 : 0;
    return count;
  }

  test::CapturedEvents events_;
};

TEST_F(FusionTiles, GiveNearlyTheCloudOfOnePiece) {
  cloud_in(1);
  const fs::path ply = fs::path(options_.output.scene).replace_extension(".ply");
  const PointCloud whole = io::read_cloud_ply(ply);
  cloud_in(3);
  const PointCloud tiled = io::read_cloud_ply(ply);
  const auto places = [](const PointCloud& points) {
    std::set<std::array<float, 3>> all;
    for (const Eigen::Vector3f& p : points.positions) all.insert({p.x(), p.y(), p.z()});
    return all;
  };
  const auto a = places(whole), b = places(tiled);
  std::vector<std::array<float, 3>> only;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(only));
  EXPECT_GT(whole.size(), 5000u);
  EXPECT_LT(only.size(), whole.size() / 500);
  EXPECT_NE(whole.positions, tiled.positions);  // the points of a tile come one after the other
  EXPECT_EQ(tiled.normals.size(), tiled.size());
  EXPECT_EQ(tiled.colors.size(), tiled.size());
}

TEST_F(FusionTiles, MadeInAnyOrderGiveTheBytesOfOneRun) {
  options_.fusion.errors = true;
  options_.output.report = options_.survey.files.working_folder / "report.json";
  const auto counts = [&] {  // the rest depends on whether the run made the maps
    const std::string report = read_file(options_.output.report);
    return report.substr(report.find("\"fusion\""));
  };
  const std::string expected = cloud_in(3), counted = counts();
  EXPECT_EQ(tile_files(), 0u);
  fs::remove(fs::path(options_.output.scene).replace_extension(".ply"));
  std::size_t points = 0;
  for (const std::size_t tile : {3u, 1u, 2u}) {
    const Report made = densify(with_tile(tile, 3));
    EXPECT_EQ(made.result, Result::tile);
    EXPECT_EQ(made.cloud, tile_path(tile, 3));
    EXPECT_EQ(io::read_cloud_ply(made.cloud).size(), made.points);
    points += made.points;
  }
  EXPECT_EQ(tile_files(), 6u);
  EXPECT_FALSE(fs::exists(fs::path(options_.output.scene).replace_extension(".ply")));
  events_.lines.clear();
  EXPECT_EQ(cloud_in(3), expected);
  EXPECT_THAT(events_.lines, HasSubstr("tile2-3.ply: exists already"));
  EXPECT_THAT(events_.lines, Not(HasSubstr("Tile ")));  // none was fused again
  EXPECT_EQ(counts(), counted);
  EXPECT_EQ(tile_files(), 0u);
  EXPECT_EQ(io::read_cloud_ply(fs::path(options_.output.scene).replace_extension(".ply")).size(),
            points);
}

TEST_F(FusionTiles, AStoppedRunGoesOnWithTheFirstMissingTile) {
  const std::string expected = cloud_in(3);
  densify(with_tile(1, 3));
  densify(with_tile(2, 3));
  fs::resize_file(tile_path(2, 3), 2000);  // damaged
  densify(with_tile(3, 3));
  fs::remove(tile_path(3, 3).string() + ".json");  // killed before the side file
  events_.lines.clear();
  EXPECT_EQ(cloud_in(3), expected);
  EXPECT_THAT(events_.lines, HasSubstr("tile1-3.ply: exists already"));
  EXPECT_THAT(events_.lines, HasSubstr("Tile 2 of 3: "));
  EXPECT_THAT(events_.lines, HasSubstr("Tile 3 of 3: "));
}

TEST_F(FusionTiles, OfOtherSettingsOrMapsAreMadeAgain) {
  cloud_in(2);
  densify(with_tile(1, 2));
  options_.fusion.min_views = 2;
  const std::string two_views = cloud_in(2);
  densify(with_tile(1, 2));
  EXPECT_EQ(cloud_in(2), two_views);
  densify(with_tile(1, 2));
  fs::remove(map(2));
  options_.matching.make_maps = false;  // the tile was made from four maps
  events_.lines.clear();
  cloud_in(2);
  EXPECT_THAT(events_.lines, HasSubstr("Tile 1 of 2: "));
}

TEST_F(FusionTiles, AreTheSameForAnyThreadsAndMemory) {
  const std::string expected = cloud_in(4);
  EXPECT_EQ(cloud_in(4, 1), expected);
  EXPECT_EQ(cloud_in(4, 2), expected);
  Options options = options_;
  options.fusion.tiles = 4;
  densify(options, {}, with_memory(least_memory(options)));
  EXPECT_EQ(cloud(), expected);
}

TEST_F(FusionTiles, OneTileIsTheWholeCloud) {
  const std::string expected = cloud_in(1);
  densify(with_tile(1, 1));
  EXPECT_EQ(tile_files(), 2u);
  EXPECT_EQ(cloud_in(1), expected);
  EXPECT_EQ(tile_files(), 0u);
}

TEST_F(FusionTiles, NeedCompleteDepthMapsOfTheSameSettings) {
  const auto refusal = [&](std::size_t tile) {
    return test::error_of([&] { densify(with_tile(tile, 2)); });
  };
  EXPECT_THAT(refusal(1), HasSubstr("depth0000.dmap: the depth map does not exist, and tile"));
  for (const auto& [passes, filters] :
       {std::pair{0, 0u}, std::pair{1, kSpeckles}, std::pair{1, kSpeckles | kAdjust}}) {
    options_.matching.geometric_iterations = passes;
    options_.matching.postprocess = filters;
    options_.fusion.fuse = false;
    densify(options_);
    options_.fusion.fuse = true;
    EXPECT_GT(densify(with_tile(2, 2)).points, 1000u);
  }
  options_.matching.iterations = 2;
  EXPECT_THAT(refusal(1), HasSubstr("other input or with other options"));
  options_.matching.iterations = 1;
  fs::resize_file(map(2), 1000);
  EXPECT_THAT(refusal(2), HasSubstr("depth0002.dmap: the depth map is damaged"));
  fs::remove(map(2));
  EXPECT_THAT(refusal(2), HasSubstr("depth0002.dmap: the depth map does not exist"));
  EXPECT_EQ(tile_files(), 2u);  // of the last run that was not refused
}

// A strip of views 1 m apart. Each sees the points below it and below the next view.
Project strip(std::size_t count) {
  Project project;
  project.neighbours.resize(count);
  project.sources.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    SceneImage image;
    image.pose.centre = {static_cast<double>(i), 0, -2};
    project.scene.images.push_back(image);
    project.references.push_back(i);
    for (const std::uint32_t neighbour : {i - 1, i + 1})
      if (neighbour < count) project.neighbours[i].push_back({.image = neighbour});
    SparsePoint point;
    point.views = {{i, 0}};
    for (int k = 0; k < 10; ++k) {
      point.position = {static_cast<float>(i) + 0.1f * static_cast<float>(k), 0, 0};
      project.scene.points.push_back(point);
    }
  }
  return project;
}

TEST(TilesOf, AStripDivideItsLength) {
  const Project project = strip(100);
  FusionOptions options;
  options.tiles = 4;
  const auto parts = tiles_of(project, options);
  ASSERT_EQ(parts.size(), 4u);
  for (int i = 1; i < 4; ++i) {
    const auto tile = static_cast<std::size_t>(i);
    EXPECT_NEAR(parts[tile].tile.low.x(), 25 * i, 0.2);
    EXPECT_EQ(parts[tile].tile.low.x(), parts[tile - 1].tile.high.x());
    EXPECT_EQ(parts[tile].tile.low.y(), -cloud::Tile::kInfinity);
    // The margin follows from the depth, which is 2 m to 2.2 m.
    const double margin = parts[tile].tile.low.x() - parts[tile].reach.low.x();
    EXPECT_NEAR(margin, kMarginInThresholds * options.depth_threshold * 2.1, 0.02);
  }
}

TEST(TilesOf, AStripNeedMarksOfTheirViewsOnly) {
  const Project project = strip(100);
  FusionOptions options;
  EXPECT_EQ(longest_lists(project, {}, options).marked, 100u);
  options.tiles = 4;
  const std::size_t marked = longest_lists(project, {}, options).marked;
  EXPECT_GE(marked, 25u + 2);  // the views of a tile and their neighbours
  EXPECT_LE(marked, 25u + 6);
}

TEST(TilesOf, ACroppedSceneDivideTheRegion) {
  Project project = strip(100);
  OrientedBox region;
  region.centre = {10, 0, 0};
  region.half_extent = {10, 1, 1};
  project.scene.region = region;
  FusionOptions options;
  options.tiles = 2;
  EXPECT_NEAR(tiles_of(project, options)[1].tile.low.x(), 10, 0.2);
  options.crop_to_roi = false;
  EXPECT_NEAR(tiles_of(project, options)[1].tile.low.x(), 50, 0.2);
}

}  // namespace
}  // namespace axial::densify
