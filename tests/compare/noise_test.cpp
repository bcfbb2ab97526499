// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/noise.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

namespace axial::test {
namespace {

using compare::Noise;

cv::Mat1f noise_map(int side, double sigma) {
  std::mt19937_64 random(7);
  std::normal_distribution<float> normal(0, static_cast<float>(sigma));
  cv::Mat1f map(side, side);
  for (float& value : map) value = normal(random);
  return map;
}

Noise estimated(const cv::Mat1f& difference) {
  return compare::estimate_noise(difference, cv::Mat1f(difference.size(), 1.f), 1e-6);
}

TEST(Noise, IsTheStandardDeviation) {
  const Noise noise = estimated(noise_map(256, 0.002));
  EXPECT_NEAR(noise.typical, 0.002, 0.0001);
  EXPECT_GT(noise.lowest, 0.0016);
  EXPECT_LT(noise.highest, 0.0024);
  EXPECT_LT(noise.correlation, 1.4);
}

TEST(Noise, IsMeasuredOnLevelGround) {
  const cv::Mat1f difference = noise_map(256, 0.002);
  const cv::Mat1f steepness(difference.size(), 2.f);
  EXPECT_NEAR(compare::estimate_noise(difference, steepness, 1e-6).typical, 0.001, 0.0001);
}

TEST(Noise, LeavesOutChangedGroundAndPlacesWithoutSurface) {
  cv::Mat1f difference = noise_map(256, 0.002);
  difference(cv::Rect(0, 0, 256, 64)) += 0.3f;  // a quarter of the map
  difference(cv::Rect(100, 100, 50, 50)) = std::numeric_limits<float>::quiet_NaN();
  const Noise noise = estimated(difference);
  EXPECT_NEAR(noise.typical, 0.002, 0.0002);
  EXPECT_NEAR(noise.at(16, 100), 0.002, 0.0005);  // changed evenly
}

TEST(Noise, IsLocal) {
  cv::Mat1f difference = noise_map(256, 0.002);
  difference(cv::Rect(128, 128, 64, 64)) *= 2.5f;
  const Noise noise = estimated(difference);
  EXPECT_NEAR(noise.at(160, 160), 0.005, 0.0006);
  EXPECT_NEAR(noise.at(40, 40), 0.002, 0.0003);
}

TEST(Noise, StatesHowManyPixelsAreCorrelated) {
  cv::Mat1f coarse = noise_map(128, 0.002), difference;
  cv::resize(coarse, difference, {}, 4, 4, cv::INTER_NEAREST);
  const Noise noise = estimated(difference);
  EXPECT_NEAR(noise.typical, 0.002, 0.0002);
  EXPECT_GT(noise.correlation, 11);  // 16 equal pixels
  EXPECT_LT(noise.correlation, 21);
}

TEST(Noise, OfSurveysWithoutNoiseIsTheLeastOne) {
  EXPECT_EQ(estimated(cv::Mat1f(64, 64, 0.f)).typical, 1e-6);
}

TEST(Noise, CanBeGiven) {
  const cv::Mat1f difference = noise_map(256, 0.002);
  const Noise noise = compare::given_noise(difference, cv::Mat1f(difference.size(), 1.f), 0.004);
  EXPECT_TRUE(noise.is_given);
  EXPECT_EQ(noise.typical, 0.004);
  EXPECT_FLOAT_EQ(noise.at(255, 255), 0.004f);
}

}  // namespace
}  // namespace axial::test
