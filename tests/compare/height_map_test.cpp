// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/height_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/order_statistics.h"
#include "two_surveys.h"

namespace axial::test {
namespace {

using namespace compare;

double plane(double x, double y) {
  return 0.5 * x - 0.25 * y;
}

TEST(HeightMap, HasTheHeightsAndSlopesOfAPlane) {
  const Mesh mesh = surveyed({.noise = 0}, plane);
  const map::MapFrame frame;
  map::MapGrid grid = map::grid_around(mesh, frame, 0.05);
  grid.columns += 2;  // beyond the mesh
  for (const int samples : {1, 3}) {
    const cv::Mat1f heights = height_map(mesh, frame, grid, 1.0, samples);
    for (int y = 0; y < grid.rows; ++y)
      for (int x = 0; x < grid.columns; ++x) {
        const bool inside = x < grid.columns - 2;
        ASSERT_EQ(std::isnan(heights(y, x)), !inside);
        if (!inside) continue;
        const double east = grid.left + (x + 0.5) * grid.pixel;
        const double north = grid.top - (y + 0.5) * grid.pixel;
        ASSERT_NEAR(heights(y, x), plane(east, north) - 1, 1e-5);
        const Eigen::Vector2d slope = slope_at(heights, y, x, grid.pixel);
        ASSERT_NEAR(slope.x(), 0.5, 1e-4);
        ASSERT_NEAR(slope.y(), -0.25, 1e-4);
      }
  }
}

TEST(HeightMap, BendsAtEdges) {
  cv::Mat1f heights(5, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) heights(y, x) = 0.25f * static_cast<float>(std::abs(x - 2) + y);
  EXPECT_FLOAT_EQ(static_cast<float>(bend_at(heights, 2, 2)), 0.5f);
  EXPECT_EQ(bend_at(heights, 2, 1), 0);
  EXPECT_EQ(bend_at(heights, 2, 0), 0);  // along y alone
  heights(2, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(bend_at(heights, 2, 2), 0);
}

TEST(RobustDeviation, IsThatOfANormalDistributionInSpiteOfOutliers) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(5, 2);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) values.push_back(i % 50 == 0 ? 1000 : normal(random));
  EXPECT_NEAR(robust_deviation(values), 2, 0.1);
  EXPECT_EQ(robust_deviation({}), 0);
}

}  // namespace
}  // namespace axial::test
