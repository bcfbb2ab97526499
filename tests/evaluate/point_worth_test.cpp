// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/point_worth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace axial::evaluate {
namespace {

TEST(ErrorsByViews, SplitsThePointsByTheMapsTheyRestOn) {
  const std::vector<std::uint32_t> views{2, 2, 3, 5, 9, 2, 1};
  const std::vector<float> distances{0.001f, 0.003f, 0.002f, 0.001f, 0.050f, 0.005f, 0.003f};
  const std::vector<double> tolerances{0.002};
  const auto classes = errors_by_views(views, distances, tolerances, 0.02);
  ASSERT_EQ(classes.size(), 3u);
  EXPECT_EQ(classes[0].points, 4u);
  EXPECT_NEAR(classes[0].mean, 0.003, 1e-8);
  EXPECT_NEAR(classes[0].share, 4.0 / 7, 1e-12);
  EXPECT_NEAR(classes[0].within[0], 0.25, 1e-12);
  EXPECT_EQ(classes[0].gross_share, 0);
  EXPECT_EQ(classes[1].points, 1u);
  EXPECT_NEAR(classes[1].within[0], 1, 1e-12);
  EXPECT_EQ(classes[2].points, 2u);
  EXPECT_NEAR(classes[2].gross_share, 0.5, 1e-12);
}

struct Cloud {
  PointWorth worth;
  std::vector<float> distances;
};

// Errors drawn as they are expected; a tenth of the points ten times as far off, and known to be so
// by their confidence.
Cloud honest_cloud() {
  Cloud cloud;
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 100000; ++i) {
    const float expected = 0.001f * static_cast<float>(1 + i % 5);
    const bool gross = i % 10 == 0;
    cloud.worth.error.push_back(expected);
    cloud.worth.confidence.push_back(gross ? 0.25f : 1.0f);
    cloud.distances.push_back(std::abs((gross ? 10 : 1) * expected * normal(random)));
  }
  return cloud;
}

TEST(Calibration, IsOneWhereErrorsAreAsExpected) {
  Cloud cloud = honest_cloud();
  for (std::size_t i = 0; i < cloud.distances.size(); i += 10) cloud.distances[i] /= 10;
  const auto calibration = calibration_of(cloud.worth, cloud.distances);
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->points, 100000u);
  // Standard error of the RMS of n normal numbers: 1 / sqrt(2 n).
  EXPECT_NEAR(calibration->rms, 1, 0.01);
  EXPECT_NEAR(calibration->median, 0.6745, 0.01);
  EXPECT_NEAR(calibration->within[0], 0.6827, 0.01);
  EXPECT_NEAR(calibration->within[2], 0.9973, 0.002);
  for (float& error : cloud.worth.error) error *= 2;
  EXPECT_NEAR(calibration_of(cloud.worth, cloud.distances)->rms, 0.5, 0.005);
}

TEST(Calibration, TellsOfEveryConfidenceHowManyPointsDeserveIt) {
  const Cloud cloud = honest_cloud();
  const auto calibration = calibration_of(cloud.worth, cloud.distances);
  ASSERT_EQ(calibration->reliability.size(), 10u);
  const Reliability &quarter = calibration->reliability[2], &sure = calibration->reliability[9];
  EXPECT_EQ(quarter.points, 10000u);
  EXPECT_NEAR(quarter.mean_confidence, 0.25, 1e-9);
  EXPECT_NEAR(quarter.within, 0.2358, 0.02) << "a normal number within 0.3";
  EXPECT_EQ(sure.points, 90000u);
  EXPECT_NEAR(sure.within, 0.9973, 0.002);
  EXPECT_EQ(calibration->reliability[5].points, 0u);
}

TEST(Calibration, GoesByThePointsThatExpectAnError) {
  const std::vector<float> distances{0.001f, 0.002f, 0.003f, 0.004f};
  EXPECT_FALSE(calibration_of({}, distances));
  PointWorth worth;
  worth.error = {0.001f, 0.0f, NAN, 0.004f};
  EXPECT_EQ(calibration_of(worth, distances)->points, 2u);
  EXPECT_NEAR(calibration_of(worth, distances)->rms, 1, 1e-6);
  EXPECT_TRUE(calibration_of(worth, distances)->reliability.empty());
  worth.confidence = {0.5f, 0.5f, 0.5f, 1.5f};
  EXPECT_THROW(calibration_of(worth, distances), Error);
}

}  // namespace
}  // namespace axial::evaluate
