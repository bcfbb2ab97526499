// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "color/difference.h"
#include "color/transfer.h"
#include "drawn_chart.h"

namespace axial::color {
namespace {

// Blobs of light, in which there is no chart.
cv::Mat3f seabed(cv::Size size, unsigned seed) {
  cv::Mat small(size / 8, CV_32FC3);
  cv::RNG random(seed);
  random.fill(small, cv::RNG::UNIFORM, 0.05, 0.4);
  cv::Mat3f light;
  cv::resize(small, light, size, 0, 0, cv::INTER_CUBIC);
  return light;
}

cv::Mat3b values_of(const cv::Mat3f& light) {
  cv::Mat3b values(light.size());
  const Transfer srgb;
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x)
      for (int k = 0; k < 3; ++k)
        values(y, x)[2 - k] = cv::saturate_cast<uchar>(255 * srgb.value(light(y, x)[k]));
  return values;
}

// Pairs and differences published by Sharma, Wu and Dalal (2005).
TEST(Difference, IsThatOfThePublishedPairs) {
  using Lab = std::array<double, 3>;
  EXPECT_NEAR(ciede2000(Lab{50, 2.6772, -79.7751}, Lab{50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{50, 0, 0}, Lab{50, -1, 2}), 2.3669, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{50, 2.49, -0.001}, Lab{50, -2.49, 0.0009}), 7.1792, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{50, 2.49, -0.001}, Lab{50, -2.49, 0.0011}), 7.2195, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{50, 2.5, 0}, Lab{50, 0, -2.5}), 4.3065, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{50, 2.5, 0}, Lab{73, 25, -18}), 27.1492, 1e-4);
  EXPECT_NEAR(ciede2000(Lab{60.2574, -34.0099, 36.2677}, Lab{60.4626, -34.1751, 39.4387}), 1.2644,
              1e-4);
  const auto [lightness, a, b] = lab_of(Eigen::Array3f::Ones());
  EXPECT_NEAR(lightness, 100, 1e-6);
  EXPECT_NEAR(std::hypot(a, b), 0, 1e-3);
}

TEST(Chart, IsFoundTurnedTiltedAndSmall) {
  struct Placed {
    double length, degrees, tilt;
  };
  for (const Placed& placed : {Placed{500, 0, 0}, Placed{400, 100, 0.15}, Placed{700, 190, 0.1},
                               Placed{250, -35, 0.1}, Placed{180, 20, 0}}) {
    SCOPED_TRACE(placed.length);
    cv::Mat3f light = seabed({1200, 900}, 3);
    const cv::Matx33d map =
        test::place_chart({610, 440}, placed.length, placed.degrees, placed.tilt);
    test::draw_chart(map, light);
    const std::vector<Chart> charts = find_charts(values_of(light));
    ASSERT_EQ(charts.size(), 1U);
    PatchLights lights;
    for (std::size_t i = 0; i < kPatches; ++i) {
      const cv::Point2d truth = test::mapped(map, test::middle_of_patch(i));
      const std::vector<cv::Point> pixels = pixels_of_patch(charts[0], i, light.size());
      ASSERT_FALSE(pixels.empty()) << i;
      cv::Point2d mean;
      Eigen::Array3f sum = Eigen::Array3f::Zero();
      for (const cv::Point& pixel : pixels) {
        mean += cv::Point2d(pixel) / static_cast<double>(pixels.size());
        const cv::Vec3f& seen = light(pixel);
        sum += Eigen::Array3f(seen[0], seen[1], seen[2]);
      }
      // The middle half of a patch is used: it may be off by a quarter of a patch of length / 6.7.
      EXPECT_LT(cv::norm(mean - truth), placed.length / 6.7 / 4) << i;
      lights[i] = sum / static_cast<float>(pixels.size());
    }
    const Eigen::Array3f gain = gain_of(lights);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(gain[k], 1, 0.02);
    EXPECT_LT(chart_error(lights, gain), 1);
  }
}

// Also in a photograph that is reduced while charts are looked for.
TEST(Chart, SeveralAreFoundInALargePhotograph) {
  cv::Mat3f light = seabed({3200, 1600}, 4);
  const std::array<cv::Point2d, 2> middles{{{600, 500}, {2300, 900}}};
  for (const cv::Point2d& middle : middles)
    test::draw_chart(test::place_chart(middle, 500, 30, 0.05), light);
  const std::vector<Chart> charts = find_charts(values_of(light));
  ASSERT_EQ(charts.size(), 2U);
  for (const cv::Point2d& middle : middles)
    EXPECT_TRUE(std::ranges::any_of(charts, [&](const Chart& chart) {
      const auto& [a, b, c, d] = chart.corners;
      return cv::norm(cv::Point2d((a + b + c + d) / 4) - middle) < 20;  // of 500
    }));
}

TEST(Chart, IsToldFromOtherPatches) {
  const std::array<bool, 3> all{true, true, true};
  PatchLights lights = chart_colors();
  for (Eigen::Array3f& light : lights) light = light * Eigen::Array3f(0.2f, 3, 1) + 0.01f;
  EXPECT_NEAR(likeness(lights, all), 1, 1e-5);
  cv::RNG random(5);
  for (int i = 0; i < 1000; ++i) {
    for (Eigen::Array3f& light : lights)
      light = {random.uniform(0.0f, 1.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 1.0f)};
    EXPECT_LT(likeness(lights, all), kLeastLikeness);
  }
  // A channel that the water took.
  lights = chart_colors();
  for (std::size_t i = 0; i < kPatches; ++i) lights[i][0] = i % 2 ? 0.1f : 0.2f;
  EXPECT_LT(likeness(lights, all), kLeastLikeness);
  EXPECT_NEAR(likeness(lights, {false, true, true}), 1, 1e-5);
  EXPECT_EQ(likeness(lights, {false, false, false}), 0);
  for (std::size_t i = 0; i < 13; ++i) lights[i].setConstant(NAN);
  EXPECT_EQ(likeness(lights, {false, true, true}), 0);
}

TEST(Chart, IsNotFoundWhereThereIsNone) {
  for (unsigned seed = 1; seed <= 3; ++seed)
    EXPECT_TRUE(find_charts(values_of(seabed({640, 480}, seed))).empty());
  EXPECT_TRUE(find_charts(cv::Mat3b(480, 640, cv::Vec3b(0, 0, 0))).empty());
  EXPECT_TRUE(find_charts(cv::Mat3b(3, 2, cv::Vec3b(9, 0, 200))).empty());
}

TEST(Chart, GivesTheGainOfEachChannel) {
  const Eigen::Array3f cast(0.5f, 1.25f, 2.0f);
  PatchLights lights = chart_colors();
  for (Eigen::Array3f& light : lights) light *= cast;
  lights[19].setConstant(9);  // a reflection
  lights[20][1] = NAN;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(gain_of(lights)[k] * cast[k], 1, 1e-5);
  EXPECT_LT(chart_error(lights, gain_of(lights)), 1e-3);
  EXPECT_GT(chart_error(lights, Eigen::Array3f::Ones()), 10);
  for (std::size_t i = 18; i < 21; ++i) lights[i].setConstant(-1);
  EXPECT_TRUE(gain_of(lights).isNaN().all());
  EXPECT_TRUE(std::isnan(chart_error(lights, gain_of(lights))));
}

}  // namespace
}  // namespace axial::color
