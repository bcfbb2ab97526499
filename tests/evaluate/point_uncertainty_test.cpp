// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/point_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

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
  PointUncertainty uncertainty;
  std::vector<float> distances;
};

// Errors follow their expected distribution. A tenth of the points are off ten times as far, and
// have a low confidence.
Cloud honest_cloud() {
  Cloud cloud;
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 100000; ++i) {
    const float expected = 0.001f * static_cast<float>(1 + i % 5);
    const bool gross = i % 10 == 0;
    cloud.uncertainty.error.push_back(expected);
    cloud.uncertainty.confidence.push_back(gross ? 0.25f : 1.0f);
    cloud.distances.push_back(std::abs((gross ? 10 : 1) * expected * normal(random)));
  }
  return cloud;
}

TEST(Calibration, IsOneWhereErrorsAreAsExpected) {
  Cloud cloud = honest_cloud();
  for (std::size_t i = 0; i < cloud.distances.size(); i += 10) cloud.distances[i] /= 10;
  const auto calibration = calibration_of(cloud.uncertainty, cloud.distances);
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->all.points, 100000u);
  // The standard error of the RMS of n normal numbers is 1 / sqrt(2 n).
  EXPECT_NEAR(calibration->all.rms, 1, 0.01);
  EXPECT_NEAR(calibration->all.median, 0.6745, 0.01);
  EXPECT_NEAR(calibration->all.within[0], 0.6827, 0.01);
  EXPECT_NEAR(calibration->all.within[2], 0.9973, 0.002);
  for (float& error : cloud.uncertainty.error) error *= 2;
  EXPECT_NEAR(calibration_of(cloud.uncertainty, cloud.distances)->all.rms, 0.5, 0.005);
}

TEST(Calibration, TellsOfEveryConfidenceHowManyPointsDeserveIt) {
  const Cloud cloud = honest_cloud();
  const auto calibration = calibration_of(cloud.uncertainty, cloud.distances);
  ASSERT_EQ(calibration->reliability.size(), 10u);
  const Reliability &quarter = calibration->reliability[2], &sure = calibration->reliability[9];
  EXPECT_EQ(quarter.points, 10000u);
  EXPECT_NEAR(quarter.mean_confidence, 0.25, 1e-9);
  EXPECT_NEAR(quarter.within, 0.2358, 0.02) << "a normal number within 0.3";
  EXPECT_EQ(sure.points, 90000u);
  EXPECT_NEAR(sure.within, 0.9973, 0.002);
  EXPECT_EQ(calibration->reliability[5].points, 0u);
}

// Points of two maps have errors of half the expected size, points of more maps have errors as
// expected.
TEST(Calibration, TellsPointsOfTwoMapsFromTheRest) {
  Cloud cloud = honest_cloud();
  EXPECT_TRUE(calibration_of(cloud.uncertainty, cloud.distances)->by_views.empty());
  for (std::size_t i = 0; i < cloud.distances.size(); ++i) {
    cloud.uncertainty.views.push_back(static_cast<std::uint32_t>(i % 10 == 0 ? 2 : 4 + i % 3));
    if (i % 10 == 0) cloud.distances[i] /= 20;
  }
  cloud.uncertainty.error[0] = 0;
  const auto calibration = calibration_of(cloud.uncertainty, cloud.distances);
  ASSERT_EQ(calibration->by_views.size(), 3u);
  const auto& [two, three, more] =
      std::tie(calibration->by_views[0], calibration->by_views[1], calibration->by_views[2]);
  EXPECT_EQ(two.most, 2u);
  EXPECT_EQ(two.errors.points, 9999u);
  EXPECT_NEAR(two.errors.rms, 0.5, 0.02);
  EXPECT_NEAR(two.errors.within[0], 0.9545, 0.02);
  EXPECT_EQ(three.errors.points, 0u);
  EXPECT_EQ(more.least, 4u);
  EXPECT_EQ(more.errors.points, 90000u);
  EXPECT_NEAR(more.errors.rms, 1, 0.01);
}

TEST(Calibration, GoesByThePointsThatExpectAnError) {
  const std::vector<float> distances{0.001f, 0.002f, 0.003f, 0.004f};
  EXPECT_FALSE(calibration_of({}, distances));
  PointUncertainty uncertainty;
  uncertainty.error = {0.001f, 0.0f, NAN, 0.004f};
  EXPECT_EQ(calibration_of(uncertainty, distances)->all.points, 2u);
  EXPECT_NEAR(calibration_of(uncertainty, distances)->all.rms, 1, 1e-6);
  EXPECT_TRUE(calibration_of(uncertainty, distances)->reliability.empty());
  uncertainty.confidence = {0.5f, 0.5f, 0.5f, 1.5f};
  EXPECT_THROW(calibration_of(uncertainty, distances), Error);
}

}  // namespace
}  // namespace axial::evaluate
