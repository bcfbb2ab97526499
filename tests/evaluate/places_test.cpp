// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/places.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/cloud_evaluation.h"
#include "evaluate/shapes.h"
#include "evaluate/strip.h"
#include "worlds/ports.h"

namespace axial::evaluate {
namespace {

constexpr double kTolerance = 0.02;

// A camera at (x, 0, 0) that looks along +z. At a distance of 1 m it sees 2 m in x and 1 m in y.
View camera_at(double x) {
  return {test::camera_at({x, 0, 0}, 200, 100, 100)};
}

// A grid of points 1 cm apart on a part of the floor.
std::vector<Eigen::Vector3f> grid(double from, double to, double step = 0.01) {
  std::vector<Eigen::Vector3f> points;
  for (double x = from; x <= to; x += step)
    for (double y = -0.6; y <= 0.6; y += 0.01)
      points.push_back(Eigen::Vector3d(x, y, 1).cast<float>());
  return points;
}

CloudEvaluation evaluated(const std::vector<Eigen::Vector3f>& points, const Mesh& truth,
                          const std::vector<View>& views, std::uint32_t least = 2) {
  CloudOptions options;
  options.samples = 40000;
  options.tolerances = {kTolerance, 10};
  options.least_views = least;
  return evaluate_cloud(points, truth, geometry::Surface(truth), views, options);
}

TEST(RecallByViews, IsOfThePlacesThatExactlySoManySee) {
  const Mesh floor = height_field(1, 8, [](double, double) { return 1.0; });
  // Along x, one camera sees [-1, 0], two see [0, 0.5], three see [0.5, 1], two see [1, 2] and one
  // sees [2, 2.5].
  const std::vector<View> views{camera_at(0), camera_at(1), camera_at(1.5)};
  const CloudEvaluation e = evaluated(grid(0, 0.75), floor, views);
  ASSERT_EQ(e.by_views.size(), 3u);
  const RecallOfViews &two = e.by_views[0], &three = e.by_views[1], &more = e.by_views[2];
  EXPECT_EQ(two.least, 2u);
  EXPECT_EQ(two.most, 2u);
  EXPECT_EQ(more.least, 4u);
  EXPECT_EQ(more.most, 0u);
  EXPECT_EQ(more.places, 0u);
  // About 25000 samples count, so shares are accurate to a percent.
  EXPECT_NEAR(static_cast<double>(two.places) / static_cast<double>(three.places), 3, 0.2);
  EXPECT_NEAR(two.recall[0], 0.5 / 1.5, 0.03);
  EXPECT_NEAR(three.recall[0], 0.25 / 0.5 + kTolerance / 0.5, 0.04);
  EXPECT_EQ(two.recall[1], 1) << "at the other tolerance";
  // The classes together are the whole.
  const double both = (two.recall[0] * static_cast<double>(two.places) +
                       three.recall[0] * static_cast<double>(three.places)) /
                      static_cast<double>(two.places + three.places);
  EXPECT_NEAR(both, e.scores[0].recall, 1e-12);
}

TEST(RecallByViews, BeginsWithTheLeastNumberThatCounts) {
  const Mesh floor = height_field(1, 4, [](double, double) { return 1.0; });
  const std::vector<View> six(6, camera_at(0));
  const std::vector<std::pair<std::uint32_t, std::size_t>> cases{{1, 4}, {2, 3}, {4, 1}, {5, 1}};
  for (const auto& [least, classes] : cases) {
    const CloudEvaluation e = evaluated(grid(-1, 1), floor, six, least);
    ASSERT_EQ(e.by_views.size(), classes);
    EXPECT_EQ(e.by_views.back().least, std::max(least, 4u));
    EXPECT_EQ(e.by_views.back().places, e.places.size()) << "six see all of it";
  }
  EXPECT_TRUE(evaluated(grid(-1, 1), floor, {}).by_views.empty());
}

TEST(RecallByThickness, CountsPixelsWhereTheViewsHaveThem) {
  // Four patches at 1 m, where a pixel is 1 cm wide. Their thickness is 0.8, 2, 16 and 0 (not thin)
  // pixels.
  Mesh truth;
  std::vector<float> thickness;
  const std::vector<float> of_patches{0.008f, 0.02f, 0.16f, 0.0f};
  for (std::size_t k = 0; k < of_patches.size(); ++k) {
    Mesh patch = height_field(4, 0.2, [](double, double) { return 1.0; });
    for (auto& x : patch.vertices) x.x() += 0.4f * static_cast<float>(k) - 0.6f;
    append(truth, patch);
    thickness.insert(thickness.end(), patch.vertices.size(), of_patches[k]);
  }
  const std::vector<View> views{camera_at(-0.1), camera_at(0.1)};
  // The reconstruction has the second patch and half of the third.
  auto points = grid(-0.3, -0.1);
  for (const auto& x : grid(0.1, 0.205)) points.push_back(x);
  const CloudEvaluation e = evaluated(points, truth, views);
  const geometry::Surface surface(truth);
  const std::vector<double> tolerances{kTolerance};
  const auto classes = recall_by_thickness(e.places, e.place_distances, tolerances, truth, surface,
                                           thickness, views);
  ASSERT_EQ(classes.size(), 7u);
  std::size_t places = 0;
  for (const RecallOfThickness& one : classes) places += one.places;
  EXPECT_EQ(places, e.places.size());
  // The classes: about 1, 2, 4, 8, 16 px, thicker, not thin.
  const double quarter = static_cast<double>(places) / 4;
  for (const std::size_t k : {0u, 1u, 4u, 6u})
    EXPECT_NEAR(static_cast<double>(classes[k].places), quarter, 0.05 * quarter) << k;
  EXPECT_EQ(classes[0].recall[0], 0);
  EXPECT_NEAR(classes[1].recall[0], 1, 1e-9);
  EXPECT_NEAR(classes[4].recall[0], 0.5 + kTolerance / 0.2, 0.03);
  EXPECT_EQ(classes[6].recall[0], 0);
  EXPECT_THROW(recall_by_thickness(e.places, e.place_distances, tolerances, truth, surface,
                                   std::vector<float>(3, 1.0f), views),
               Error);
}

TEST(Strip, TellsTheDensityOfItsEmptiestAndFullestPiece) {
  const Mesh floor = height_field(1, 12, [](double, double) { return 1.0; });
  std::vector<View> views;
  for (int i = 0; i < 6; ++i) views.push_back(camera_at(0.8 * i - 2));
  auto points = grid(-3, 3);
  const CloudEvaluation even = evaluated(points, floor, views);
  const Strip same = density_along_strip(points, even.places, views);
  EXPECT_NEAR(std::abs(same.direction.x()), 1, 1e-9);
  EXPECT_GT(same.direction.x(), 0) << "from the first view on";
  // Two cameras see the ground from 1 m before the second view to 1 m after the last but one.
  EXPECT_NEAR(static_cast<double>(same.pieces.size()), 5 * 4.4 / 0.8, 1.5);
  EXPECT_LT(same.most / same.least, 1.35) << "the chance of samples, a column of points in sixteen";
  // Two more copies of the points up to x = 0.4: beyond it the density is a third.
  for (const auto& x : grid(-3, 0.4)) {
    points.push_back(x);
    points.push_back(x);
  }
  const Strip uneven = density_along_strip(points, even.places, views);
  EXPECT_NEAR(uneven.most / uneven.least, 3, 0.9);
  // A stripe without points.
  const auto bare = [](const Eigen::Vector3f& x) { return x.x() > 0 && x.x() < 0.4f; };
  std::erase_if(points, bare);
  EXPECT_EQ(density_along_strip(points, even.places, views).least, 0);
}

TEST(Strip, RefusesWhatIsNone) {
  const Mesh floor = height_field(1, 12, [](double, double) { return 1.0; });
  std::vector<View> views{camera_at(0), camera_at(0.5)};
  const auto points = grid(-1, 1);
  const Places places = evaluated(points, floor, views).places;
  EXPECT_THROW(density_along_strip(points, places, views), Error) << "two views";
  views.push_back(camera_at(0.2));
  views.back().pose.centre.y() = 0.4;
  EXPECT_THROW(density_along_strip(points, places, views), Error) << "a triangle";
  EXPECT_THROW(density_along_strip(points, places, std::vector<View>(4, camera_at(0))), Error);
}

}  // namespace
}  // namespace axial::evaluate
