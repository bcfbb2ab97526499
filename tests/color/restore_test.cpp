// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/restore.h"

#include <gtest/gtest.h>

#include <cmath>

namespace axial::color {
namespace {

SunWater water() {
  SunWater water;
  const std::array<double, 3> a{0.6, 0.3, 0.2};
  for (std::size_t k = 0; k < 3; ++k) {
    water.channels[k].a.value = a[k];
    water.channels[k].b.value = 0.3;
    water.channels[k].veil.value = 0.1;
    water.channels[k].determined = true;
  }
  return water;
}

SightImage sights(float way) {
  SightImage image(8, 6);
  for (Sight& sight : image.all) sight.way = way;
  return image;
}

// The light of a surface J (R G B) behind 2 m of water().
cv::Mat3f light(const Eigen::Array3f& surface) {
  Sight sight;
  sight.way = 2;
  const Eigen::Array3f seen = surface * water().factor(sight) + water().veil(sight);
  return cv::Mat3f(6, 8, cv::Vec3f(seen[0], seen[1], seen[2]));
}

TEST(Restore, GivesTheLightOfTheSurface) {
  const Eigen::Array3f surface(0.2f, 0.4f, 0.1f);
  const Restored eight = restore(light(surface), {}, sights(2), water(), {});
  const Restored sixteen =
      restore(light(surface), {}, sights(2), water(), {Eigen::Array3f::Ones(), {}, 16});
  ASSERT_EQ(eight.pixels.type(), CV_8UC3);
  ASSERT_EQ(sixteen.pixels.type(), CV_16UC3);
  for (int k = 0; k < 3; ++k) {
    const double value = Transfer().value(surface[k]);
    EXPECT_NEAR(eight.pixels.at<cv::Vec3b>(3, 4)[2 - k], 255 * value, 0.6);
    EXPECT_NEAR(sixteen.pixels.at<cv::Vec3w>(3, 4)[2 - k], 65535 * value, 2);
  }
  EXPECT_EQ(cv::countNonZero(eight.known), 48);
}

TEST(Restore, TellsWhatIsNotKnown) {
  cv::Mat3f image = light({0.2f, 0.4f, 0.1f});
  image(1, 1)[0] = 0.99f;  // clipped
  SightImage seen = sights(2);
  seen.at(5, 2).way = 0;
  const Restored restored = restore(image, {}, seen, water(), {});
  EXPECT_EQ(restored.known(1, 1), 0);
  EXPECT_EQ(restored.known(2, 5), 0);
  EXPECT_EQ(cv::countNonZero(restored.known), 46);
  // A pixel without surface is restored as its neighbours are.
  EXPECT_EQ(restored.pixels.at<cv::Vec3b>(2, 5), restored.pixels.at<cv::Vec3b>(2, 4));
  // After 10 m, a four-hundredth of the red light is left: one grey level.
  EXPECT_EQ(cv::countNonZero(restore(image, {}, sights(10), water(), {}).known), 0);
}

TEST(Restore, ChannelsThatAreNotDeterminedStay) {
  SunWater half = water();
  half.channels[0].determined = false;
  const cv::Mat3f image = light({0.2f, 0.4f, 0.1f});
  const Restored restored = restore(image, {}, sights(2), half, {});
  EXPECT_NEAR(restored.pixels.at<cv::Vec3b>(0, 0)[2], 255 * Transfer().value(image(0, 0)[0]), 0.6);
  EXPECT_NEAR(restored.pixels.at<cv::Vec3b>(0, 0)[1], 255 * Transfer().value(0.4f), 0.6);
}

TEST(Restore, MasksAndPhotographsWithoutSurfaceAreNotKnown) {
  const cv::Mat3f image = light({0.2f, 0.4f, 0.1f});
  cv::Mat1b mask(6, 8, std::uint8_t{255});
  mask(3, 3) = 0;
  EXPECT_EQ(cv::countNonZero(restore(image, mask, sights(2), water(), {}).known), 47);
  const Restored nothing = restore(image, {}, sights(0), water(), {});
  EXPECT_EQ(cv::countNonZero(nothing.known), 0);
  EXPECT_NEAR(nothing.pixels.at<cv::Vec3b>(0, 0)[1], 255 * Transfer().value(image(0, 0)[1]), 0.6);
}

// A channel of which the water took all is not determined and has no light: the others must not
// suffer from it.
TEST(GreyWorld, LeavesOutChannelsThatAreNotDetermined) {
  SunWater half = water();
  half.channels[0].determined = false;
  Observations observations;
  observations.first = {0, 2};
  for (int i = 0; i < 2; ++i) {
    Observation seen;
    seen.sight.way = 2;
    const Eigen::Array3f factor = half.factor(seen.sight);
    seen.light = Eigen::Array3f(0.2f, 0.4f, 0.1f) * factor + half.veil(seen.sight);
    seen.light[0] = 0;
    observations.all.push_back(seen);
  }
  const Eigen::Array3f gain = grey_world(observations, half);
  EXPECT_EQ(gain[0], 1);
  EXPECT_NEAR(gain[1] * 0.4, 0.7, 1e-4);
  EXPECT_NEAR(gain[2] * 0.1, 0.7, 1e-4);
}

TEST(FillSights, TakesTheNearestAndKeepsTheOthers) {
  SightImage seen = sights(0);
  seen.at(0, 0).way = 1;
  seen.at(7, 5).way = 3;
  seen.at(1, 0).place = {0.5f, 0.25f};
  fill_sights(seen);
  EXPECT_EQ(seen.at(0, 0).way, 1);
  EXPECT_EQ(seen.at(7, 5).way, 3);
  EXPECT_EQ(seen.at(1, 0).way, 1);
  EXPECT_EQ(seen.at(1, 0).place, Eigen::Vector2f(0.5f, 0.25f));
  EXPECT_EQ(seen.at(6, 5).way, 3);
  for (const Sight& sight : seen.all) {
    EXPECT_GT(sight.way, 0);
    EXPECT_NEAR(sight.normal.norm(), 1, 1e-6f);
  }
  SightImage none = sights(0);
  fill_sights(none);
  for (const Sight& sight : none.all) EXPECT_EQ(sight.way, 0);
}

}  // namespace
}  // namespace axial::color
