// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/changes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace axial::test {
namespace {

using namespace compare;

constexpr double kPixel = 0.1;

struct Maps {
  cv::Mat1f difference = cv::Mat1f(40, 60, 0.f);
  cv::Mat1f sigma = cv::Mat1f(40, 60, 1.f);
};

Changes changes_of(const Maps& maps, const Registration& registration = {},
                   double correlation = 1) {
  const map::MapGrid grid{10, 20, kPixel, maps.difference.cols, maps.difference.rows};
  return find_changes(maps.difference, maps.sigma, {grid, registration, correlation}, {});
}

TEST(Changes, HaveVolumesAreasAndPlaces) {
  Maps maps;
  maps.difference(cv::Rect(10, 5, 6, 4)) = 5.f;
  maps.difference(cv::Rect(30, 20, 5, 5)) = -4.f;
  maps.difference(30, 32) = std::numeric_limits<float>::quiet_NaN();
  const Changes changes = changes_of(maps);
  ASSERT_EQ(changes.regions.size(), 2u);
  EXPECT_NEAR(changes.came.volume, 24 * 5 * kPixel * kPixel, 1e-9);
  EXPECT_NEAR(changes.gone.volume, 25 * 4 * kPixel * kPixel, 1e-9);
  EXPECT_NEAR(changes.net, 20 * kPixel * kPixel, 1e-9);
  EXPECT_NEAR(changes.came.area, 24 * kPixel * kPixel, 1e-9);
  EXPECT_NEAR(changes.area_compared, (40 * 60 - 1) * kPixel * kPixel, 1e-9);
  const Region& first = changes.regions[0];  // the larger one
  EXPECT_TRUE(first.came);
  EXPECT_NEAR(first.x, 10 + 13 * kPixel, 1e-9);
  EXPECT_NEAR(first.y, 20 - 7 * kPixel, 1e-9);
  EXPECT_EQ(first.largest, 5);
  EXPECT_EQ(changes.classes(5, 10), kCame);
  EXPECT_EQ(changes.classes(22, 32), kGone);
  EXPECT_EQ(changes.classes(4, 10), kUnchanged);  // at the rim
  EXPECT_EQ(changes.classes(30, 32), kNotCompared);
}

TEST(Changes, GrowToWeakPixelsOfTheSameSign) {
  Maps maps;
  maps.difference(cv::Rect(10, 10, 4, 4)) = 5.f;
  maps.difference(cv::Rect(14, 10, 20, 4)) = 2.f;   // weak, connected
  maps.difference(cv::Rect(40, 20, 10, 10)) = 2.f;  // weak alone
  maps.difference(cv::Rect(10, 14, 4, 4)) = -2.f;   // weak, of the other sign
  const Changes changes = changes_of(maps);
  ASSERT_EQ(changes.regions.size(), 1u);
  EXPECT_NEAR(changes.came.area, (16 + 80) * kPixel * kPixel, 1e-9);
  EXPECT_EQ(changes.classes(11, 30), kCame);
  EXPECT_EQ(changes.classes(25, 45), kUnchanged);
  EXPECT_EQ(changes.classes(15, 11), kUnchanged);
}

TEST(Changes, ContinueALittleIntoUnseenPixels) {
  Maps maps;
  maps.difference(cv::Rect(10, 10, 8, 8)) = 5.f;
  maps.difference(cv::Rect(20, 10, 8, 8)) = 5.f;
  maps.difference(cv::Rect(18, 10, 2, 8)) = 5.f;   // unseen, joins both
  maps.difference(cv::Rect(28, 10, 1, 8)) = 50.f;  // unseen, of another kind
  maps.difference(cv::Rect(40, 10, 6, 8)) = 5.f;
  maps.difference(cv::Rect(46, 10, 6, 8)) = 5.f;   // unseen, too much
  maps.difference(cv::Rect(10, 30, 8, 8)) = 50.f;  // unseen alone
  cv::Mat1b unseen(40, 60, std::uint8_t{0});
  for (const cv::Rect& part : {cv::Rect(18, 10, 2, 8), cv::Rect(28, 10, 1, 8),
                               cv::Rect(46, 10, 6, 8), cv::Rect(10, 30, 8, 8)})
    unseen(part) = std::uint8_t{255};
  const map::MapGrid grid{10, 20, kPixel, 60, 40};
  const Registration registration;
  const Changes changes =
      find_changes(maps.difference, maps.sigma, {grid, registration, 1, unseen}, {});
  ASSERT_EQ(changes.regions.size(), 2u);
  EXPECT_NEAR(changes.came.area, (18 * 8 + 6 * 8) * kPixel * kPixel, 1e-9);
  EXPECT_NEAR(changes.came.volume, 5 * changes.came.area, 1e-9);
  EXPECT_NEAR(changes.area_compared, (40 * 60 - (1 + 6 + 8) * 8) * kPixel * kPixel, 1e-9);
  EXPECT_EQ(changes.classes(12, 19), kCame);
  for (const int x : {28, 46, 51}) EXPECT_EQ(changes.classes(12, x), kNotCompared);
  EXPECT_EQ(changes.classes(33, 12), kNotCompared);
}

TEST(Changes, IgnoreSmallRegions) {
  Maps maps;
  maps.difference(cv::Rect(10, 10, 7, 1)) = 50.f;
  EXPECT_TRUE(changes_of(maps).regions.empty());
  maps.difference(11, 17) = 50.f;  // touches at a corner
  EXPECT_EQ(changes_of(maps).regions.size(), 1u);
  maps.sigma(11, 17) = 20.f;  // weak
  EXPECT_TRUE(changes_of(maps).regions.empty());
}

TEST(Changes, VolumesIncludeTheRim) {
  Maps maps;
  maps.difference(cv::Rect(10, 10, 4, 4)) = 5.f;
  maps.difference(9, 10) = 0.5f, maps.difference(8, 10) = -0.25f;
  maps.difference(7, 10) = 0.5f;  // beyond the rim
  EXPECT_NEAR(changes_of(maps).came.volume, (16 * 5 + 0.25) * kPixel * kPixel, 1e-6);
}

TEST(Changes, StandardDeviationsOfVolumes) {
  Maps maps;
  maps.difference(cv::Rect(10, 10, 6, 4)) = 5.f;
  const double pixels = 10 * 8;  // with the rim
  const double area = kPixel * kPixel;
  EXPECT_NEAR(changes_of(maps).came.sigma, area * std::sqrt(pixels), 1e-9);
  EXPECT_NEAR(changes_of(maps, {}, 9).came.sigma, 3 * area * std::sqrt(pixels), 1e-9);
  Registration registration;
  registration.motion.centre = {11.3, 18.8, 0};  // the middle of the region
  registration.covariance(5, 5) = 4;             // along z: common to all pixels
  registration.covariance(0, 0) = 100;           // about the middle: no volume
  EXPECT_NEAR(changes_of(maps, registration).came.sigma,
              area * std::hypot(2 * pixels, std::sqrt(pixels)), 1e-6);
}

TEST(Changes, OfNothingAreZero) {
  const Changes changes = changes_of({});
  EXPECT_EQ(changes.came.volume, 0);
  EXPECT_EQ(changes.gone.sigma, 0);
  EXPECT_EQ(changes.net, 0);
}

}  // namespace
}  // namespace axial::test
