// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fuse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "cloud/fusion_fixture.h"

namespace axial::cloud {
namespace {

std::size_t valid_pixels(const std::vector<DepthMap>& maps) {
  std::size_t count = 0;
  for (const DepthMap& map : maps) count += static_cast<std::size_t>(cv::countNonZero(map.depth));
  return count;
}

double worst_distance(const PointCloud& cloud, const AnalyticScene& world) {
  double worst = 0;
  for (const Eigen::Vector3f& p : cloud.positions) {
    worst = std::max(worst, world.distance(p.cast<double>()));
  }
  return worst;
}

INSTANTIATE_TEST_SUITE_P(Cameras, FuseWithCamera, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

TEST_P(FuseWithCamera, PutsPointsOnThePlane) {
  const AnalyticScene world;
  Fixture fixture = make_fixture(world, model());
  const PointCloud cloud = run(fixture);
  // Nearly all pixels are seen in three views or more. With five pixels per point there are a fifth
  // as many points.
  EXPECT_GT(cloud.size(), valid_pixels(fixture.maps) / 8);
  // Depths are floats near 1 with rounding errors of 6e-8. The mean of points of a plane lies on
  // it.
  EXPECT_LT(worst_distance(cloud, world), 1e-6);
  ASSERT_EQ(cloud.normals.size(), cloud.size());
  for (const Eigen::Vector3f& n : cloud.normals) {
    ASSERT_LT((n.cast<double>() - world.plane.normal()).norm(), 1e-6);
  }
}

TEST_P(FuseWithCamera, UsesEachPixelOnce) {
  Fixture fixture = make_fixture({}, model());
  for (const std::size_t min_views : {1u, 2u, 3u, 5u}) {
    FuseOptions options;
    options.min_views = min_views;
    options.two_if_undisputed = false;
    const PointCloud cloud = run(fixture, options);
    std::vector<std::size_t> used(fixture.maps.size(), 0);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto views = cloud.views_of(i);
      EXPECT_GE(views.size(), min_views);
      // Views are strictly ascending, so that no view occurs twice.
      EXPECT_TRUE(std::adjacent_find(views.begin(), views.end(), std::greater_equal<>()) ==
                  views.end());
      for (const std::uint32_t image : views) ++used[image];
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      EXPECT_LE(used[i], static_cast<std::size_t>(cv::countNonZero(fixture.maps[i].depth)));
    }
  }
}

// Every pixel of all maps gets its own weight, so that the weights of the cloud identify pixels.
TEST_P(FuseWithCamera, UsesEachPixelOnceByItsWeight) {
  Fixture fixture = make_fixture({}, model());
  float next = 0;
  for (DepthMap& map : fixture.maps) {
    for (float& c : map.confidence) c = 0.1f + 1e-5f * next++;
  }
  FuseOptions options;
  options.min_views = 2;
  const PointCloud cloud = run(fixture, options);
  std::map<std::pair<std::uint32_t, float>, int> seen;
  for (std::size_t k = 0; k < cloud.view_images.size(); ++k) {
    ++seen[{cloud.view_images[k], cloud.view_weights[k]}];
  }
  // Few weights of different pixels are equal after rounding.
  EXPECT_GT(static_cast<double>(seen.size()), 0.99 * static_cast<double>(cloud.view_images.size()));
}

TEST_P(FuseWithCamera, MergesWhenOneViewIsEnough) {
  const AnalyticScene world;
  Fixture fixture = make_fixture(world, model());
  FuseOptions options;
  options.min_views = 1;
  const PointCloud cloud = run(fixture, options);
  EXPECT_EQ(cloud.size(), valid_pixels(fixture.maps));
  EXPECT_EQ(cloud.view_images.size(), cloud.size());
  EXPECT_LT(worst_distance(cloud, world), 1e-6);
}

TEST_P(FuseWithCamera, KeepsASphereApartFromThePlaneBehind) {
  AnalyticScene world;
  world.sphere_centre = {0, 0, 0.75};
  world.sphere_radius = 0.12;
  Fixture fixture = make_fixture(world, model());
  const PointCloud cloud = run(fixture);
  // The points of the pixels that form a point are at most a pixel (13 mm) apart. So their mean
  // lies at most 13^2 / (2 * 120) = 0.7 mm inside the sphere, and a few times as much at
  // silhouettes.
  EXPECT_LT(worst_distance(cloud, world), 3e-3);
  std::size_t on_sphere = 0;
  for (const Eigen::Vector3f& p : cloud.positions) {
    if (world.plane.absDistance(p.cast<double>()) > 0.05) ++on_sphere;
  }
  EXPECT_GT(on_sphere, 100u);
}

TEST_P(FuseWithCamera, DropsDepthsThatNobodyConfirms) {
  const AnalyticScene world;
  for (const float factor : {0.8f, 1.25f}) {
    Fixture fixture = make_fixture(world, model());
    for (int y = 20; y < 40; ++y) {
      for (int x = 30; x < 60; ++x) fixture.maps[0].depth(y, x) *= factor;
    }
    const PointCloud cloud = run(fixture);
    EXPECT_LT(worst_distance(cloud, world), 1e-6);
    EXPECT_GT(cloud.size(), 1000u);
  }
}

// Two maps agree on a plane behind the true plane, which is enough for min_views = 2. But if views
// of the true plane are fused first, the pixels that see through it are discarded.
TEST_P(FuseWithCamera, DeletesWhatLooksThroughASurface) {
  const AnalyticScene world;
  AnalyticScene wrong;
  wrong.plane = {world.plane.normal(), Eigen::Vector3d(0, 0, 1.3)};
  Fixture fixture = make_fixture(world, model());
  for (std::size_t i : {3u, 4u}) {
    fixture.maps[i] = exact_map(wrong, model(), fixture.scene.images[i].pose);
  }
  FuseOptions options;
  options.min_views = 2;
  const auto wrong_points = [&] {
    const PointCloud cloud = run(fixture, options);
    return static_cast<double>(std::count_if(
        cloud.positions.begin(), cloud.positions.end(),
        [&](const Eigen::Vector3f& p) { return world.distance(p.cast<double>()) > 0.01; }));
  };
  for (std::size_t i : {3u, 4u}) fixture.views[i].rank = 1;
  const double with_witnesses = wrong_points();
  for (std::size_t i : {3u, 4u}) fixture.views[i].rank = 9;
  const double without_witnesses = wrong_points();
  EXPECT_GT(without_witnesses, 1000);
  // The remaining wrong points lie outside the fields of the three true views and in the gaps
  // between their points.
  EXPECT_LT(with_witnesses, 0.35 * without_witnesses);
}

// Estimating errors changes no other attribute, with or without normals.
TEST_P(FuseWithCamera, EstimatesErrors) {
  Fixture fixture = make_fixture({}, model());
  FuseOptions options;
  options.normals = false;
  const PointCloud plain = run(fixture, options);
  EXPECT_TRUE(plain.errors.empty() && plain.confidences.empty());
  options.errors = true;
  PointCloud one, two;
  {
    const ThreadLimit limit(1);
    one = run(fixture, options);
  }
  {
    const ThreadLimit limit(2);
    two = run(fixture, options);
  }
  EXPECT_TRUE(same_bytes(one, two));
  ASSERT_EQ(one.errors.size(), one.size());
  ASSERT_EQ(one.confidences.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_GT(one.errors[i], 0);
    ASSERT_GT(one.confidences[i], 0);
    ASSERT_LE(one.confidences[i], 1);
  }
  one.errors.clear();
  one.confidences.clear();
  EXPECT_TRUE(same_bytes(one, plain));
}

TEST_P(FuseWithCamera, KnowsNoErrorsOfMapsWithoutConfidence) {
  Fixture fixture = make_fixture({}, model());
  for (DepthMap& map : fixture.maps) map.confidence.release();
  FuseOptions options;
  options.errors = true;
  const PointCloud cloud = run(fixture, options);
  ASSERT_GT(cloud.errors.size(), 1000u);
  EXPECT_THAT(cloud.errors, testing::Each(0.0f));
  EXPECT_THAT(cloud.confidences, testing::Each(0.0f));
}

TEST_P(FuseWithCamera, EstimatesMissingNormals) {
  const AnalyticScene world;
  Fixture fixture = make_fixture(world, model());
  for (DepthMap& map : fixture.maps) map.normal.release();
  const PointCloud cloud = run(fixture);
  ASSERT_GT(cloud.size(), 1000u);
  for (const Eigen::Vector3f& n : cloud.normals) {
    // Neighbouring points are 13 mm apart and have rounding errors of 1e-7 m.
    ASSERT_LT((n.cast<double>() - world.plane.normal()).norm(), 1e-4);
  }
}

TEST(Fuse, TreatsAPortOfAirAsNone) {
  AnalyticScene world;
  world.sphere_radius = 0.1;
  Fixture dry = make_fixture(world, test::dry_camera());
  Fixture air = make_fixture(world, test::behind_port(test::dry_camera(), 1, 1));
  const PointCloud a = run(dry), b = run(air);
  // Projections differ by rounding, which can change the nearest pixel of a point.
  EXPECT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()),
              0.005 * static_cast<double>(a.size()));
  EXPECT_LT(worst_distance(b, world), 5e-3);
  std::size_t same = 0, sought = 0;
  for (std::size_t i = 0; i < a.size(); i += 5) {  // the search takes long
    const bool found = std::any_of(b.positions.begin(), b.positions.end(), [&](const auto& q) {
      return (a.positions[i] - q).norm() < 1e-5f;
    });
    ++sought;
    if (found) ++same;
  }
  EXPECT_GT(static_cast<double>(same), 0.98 * static_cast<double>(sought));
}

TEST(Fuse, AveragesColoursByWeight) {
  Fixture fixture = make_fixture({}, test::dry_camera(), 3);
  FusionProviders providers = fixture.providers();
  providers.load_color = [&](std::size_t i) {
    return cv::Mat3b(72, 96, cv::Vec3b(static_cast<unsigned char>(100 * i), 7, 200));
  };
  const PointCloud cloud = fuse(fixture.scene, fixture.views, providers);
  ASSERT_GT(cloud.size(), 100u);
  ASSERT_EQ(cloud.colors.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    double sum = 0, total = 0;
    for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k) {
      sum += 100.0 * cloud.view_images[k] * static_cast<double>(cloud.view_weights[k]);
      total += static_cast<double>(cloud.view_weights[k]);
    }
    EXPECT_EQ(cloud.colors[i][0], 200);
    EXPECT_EQ(cloud.colors[i][1], 7);
    EXPECT_NEAR(cloud.colors[i][2], sum / total, 0.51);
  }
}

TEST(Fuse, CapsMinViewsAtTheNumberOfViews) {
  Fixture fixture = make_fixture({}, test::dry_camera(), 2);
  EXPECT_GT(run(fixture).size(), 1000u);
}

TEST(Fuse, NamesTheMapThatDoesNotFit) {
  Fixture fixture = make_fixture({}, test::dry_camera());
  fixture.maps[2].camera.width = 95;
  fixture.maps[2].image_path = "third.jpg";
  try {
    run(fixture);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("third.jpg"));
  }
  fixture.views[0].image = 77;
  EXPECT_THROW(run(fixture), Error);
}

TEST(Fuse, MakesNothingOfNothing) {
  const PointCloud cloud = fuse({}, {}, {});
  EXPECT_EQ(cloud.size(), 0u);
  EXPECT_EQ(cloud.view_begin, std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace axial::cloud
