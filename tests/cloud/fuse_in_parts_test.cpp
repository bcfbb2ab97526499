// SPDX-License-Identifier: GPL-3.0-or-later
// Threads, the loading of maps and the division into portions change no byte of the cloud.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "base/parallel.h"
#include "cloud/fusion_fixture.h"

namespace axial::cloud {
namespace {

TEST_P(FuseWithCamera, GivesTheSameBytesForAnyNumberOfThreads) {
  AnalyticScene world;
  world.sphere_centre = {0, 0, 0.75};
  world.sphere_radius = 0.12;
  Fixture fixture = make_fixture(world, model());
  PointCloud one, two;
  {
    const ThreadLimit limit(1);
    one = run(fixture);
  }
  {
    const ThreadLimit limit(2);
    two = run(fixture);
  }
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(same_bytes(one, two));
}

TEST(Fuse, LoadsEachMapOnce) {
  Fixture fixture = make_fixture({}, test::dry_camera());
  fixture.views.pop_back();  // is a neighbour of the other views, but has no map
  run(fixture);
  EXPECT_EQ(fixture.loads.size(), 4u);
  for (const auto& [image, loads] : fixture.loads) EXPECT_EQ(loads, 1) << image;
}

// Views in a ring with two neighbours each. Three maps are needed at the same time, and most maps
// are needed again later.
Fixture make_ring(const CameraModel& model) {
  AnalyticScene world;
  world.sphere_centre = {0, 0, 0.75};
  world.sphere_radius = 0.12;
  Fixture fixture = make_fixture(world, model, 8);
  for (std::uint32_t i = 0; i < 8; ++i) {
    fixture.views[i].neighbours = {(i + 3) % 8, (i + 5) % 8};
    fixture.views[i].rank = (i * 5) % 8;
  }
  return fixture;
}

TEST_P(FuseWithCamera, GivesTheSameCloudWhenMapsMustLeaveAndReturn) {
  Fixture fixture = make_ring(model());
  FuseOptions options;
  options.min_views = 2;
  const PointCloud all = run(fixture, options);
  for (const auto& [image, loads] : fixture.loads) EXPECT_EQ(loads, 1) << image;
  EXPECT_GT(all.size(), 1000u);
  fixture.loads.clear();
  options.max_maps = 1;  // fewer than one view needs: the store keeps as few as possible
  const PointCloud few = run(fixture, options);
  int loads = 0;
  for (const auto& [image, count] : fixture.loads) loads += count;
  EXPECT_GT(loads, 8);      // some maps were evicted
  EXPECT_LE(loads, 8 * 3);  // each step loads no more maps than it needs
  EXPECT_TRUE(same_bytes(all, few));
}

TEST_P(FuseWithCamera, HandsOnTheCloudInPortions) {
  Fixture fixture = make_fixture({}, model());
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  int portions = 0;
  fuse(fixture.scene, fixture.views, fixture.providers(), {}, [&](const PointCloud& portion) {
    EXPECT_GT(portion.size(), 0u);
    append(cloud, portion);
    ++portions;
  });
  EXPECT_GT(portions, 1);
  EXPECT_TRUE(same_bytes(cloud, run(fixture)));
}

TEST(Fuse, LoadsSeveralMapsAtATime) {
  Fixture fixture = make_ring(test::dry_camera());
  FuseOptions options;
  options.min_views = 2;
  const PointCloud expected = run(fixture, options);
  std::atomic<int> loading = 0, most = 0;
  FusionProviders providers;
  providers.load_map = [&](std::size_t i) {
    most = std::max<int>(most, ++loading);
    std::this_thread::yield();
    --loading;
    return fixture.maps[i];
  };
  for (const std::size_t loads : {1u, 2u}) {
    options.max_loads = loads;
    options.max_maps = 3;
    most = 0;
    EXPECT_TRUE(same_bytes(fuse(fixture.scene, fixture.views, providers, options), expected));
    EXPECT_LE(most, static_cast<int>(loads));
  }
}

}  // namespace
}  // namespace axial::cloud
