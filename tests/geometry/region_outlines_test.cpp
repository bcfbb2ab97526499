// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/region_outlines.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace axial::geometry {
namespace {

const Eigen::Vector2d kCentre(130.2, -40.7);
constexpr double kStep = 0.5;

SampleGrid grid_around(double half) {
  const int count = static_cast<int>(2 * half / kStep) + 1;
  return {kCentre - Eigen::Vector2d(half, half), kStep, count, count};
}

double radius_at(const Eigen::Vector2d& place) {
  return (place - kCentre).norm();
}

// Corners lie on the circle up to the bisection. Between them, lines leave out a hundredth of a
// step, and a line across a square between samples the sagitta of its diagonal.
void expect_circle(const Ring& ring, double radius) {
  const double sagitta = 2 * kStep * kStep / (8 * radius);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    EXPECT_NEAR(radius_at(ring[i]), radius, kStep / 100);
    EXPECT_NEAR(radius_at((ring[i] + ring[(i + 1) % ring.size()]) / 2), radius,
                0.03 * kStep + sagitta);
  }
}

TEST(RegionOutlines, OfARingWithAnIslandInItsHole) {
  const auto parts = region_outlines(grid_around(12), [](const Eigen::Vector2d& place) {
    const double r = radius_at(place);
    return (r > 6 && r < 10.3) || r < 2.1;
  });
  ASSERT_EQ(parts.size(), 2U);
  const auto& ring = parts[parts[0].size() == 2 ? 0 : 1];
  const auto& island = parts[parts[0].size() == 2 ? 1 : 0];
  ASSERT_EQ(ring.size(), 2U);
  ASSERT_EQ(island.size(), 1U);
  expect_circle(ring[0], 10.3);
  expect_circle(ring[1], 6);
  expect_circle(island[0], 2.1);
  // Along a circle, bisection leaves out 0.002, straight lines 0.005, and their sagitta is 0.003.
  constexpr double kOff = 0.01;
  EXPECT_NEAR(signed_area(ring[0]), std::numbers::pi * 10.3 * 10.3,
              kOff * 2 * std::numbers::pi * 10.3);
  EXPECT_NEAR(signed_area(ring[1]), -std::numbers::pi * 36, kOff * 2 * std::numbers::pi * 6);
}

// A hole that is lost adds its area, 113. Where the ring is narrower than the diagonal between
// samples, 0.7, it may be missing: along 8.6 with a width of 0.27 on average, 2.3. Both circles are
// off by 0.01 along 102.
TEST(RegionOutlines, KeepHolesNextToTheOutline) {
  for (int i = 0; i < 60; ++i) {
    const double gap = 0.05 + 0.02 * i, turn = 0.7 * i;
    const Eigen::Vector2d hole =
        kCentre + (10.3 - 6 - gap) * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    double area = 0;
    for (const auto& part : region_outlines(grid_around(12), [&](const Eigen::Vector2d& place) {
           return radius_at(place) < 10.3 && (place - hole).norm() > 6;
         }))
      for (const Ring& ring : part) area += signed_area(ring);
    EXPECT_NEAR(area, std::numbers::pi * (10.3 * 10.3 - 36), 3.5) << gap;
  }
}

TEST(RegionOutlines, AreFoundBeyondAGridThatIsTooSmall) {
  const auto parts = region_outlines(
      grid_around(1), [](const Eigen::Vector2d& place) { return radius_at(place) < 9; });
  ASSERT_EQ(parts.size(), 1U);
  expect_circle(parts[0][0], 9);
}

TEST(RegionOutlines, StopAtTheMostSamples) {
  const auto parts = region_outlines(
      grid_around(1), [](const Eigen::Vector2d&) { return true; }, 400);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_LT(signed_area(parts[0][0]), 450 * kStep * kStep);
}

TEST(RegionOutlines, OfSquaresThatTouchAtACornerAreApart) {
  const auto parts = region_outlines(grid_around(5), [](const Eigen::Vector2d& place) {
    const Eigen::Vector2d at = place - kCentre;
    return at.cwiseAbs().maxCoeff() < 4 && (at.x() > 0.1) == (at.y() > 0.1);
  });
  ASSERT_EQ(parts.size(), 2U);
  for (const auto& part : parts) {
    ASSERT_EQ(part.size(), 1U);
    EXPECT_GT(signed_area(part[0]), 3.5 * 3.5);
  }
}

// Half the diagonal of a square of half a step is 0.354 of a step.
TEST(RegionOutlines, CutRightAnglesByLittle) {
  for (int i = 0; i < 20; ++i) {
    const double turn = 0.37 * i;
    const Eigen::Rotation2Dd back(-turn);
    const auto parts = region_outlines(grid_around(8), [&](const Eigen::Vector2d& place) {
      return (back * (place - kCentre)).cwiseAbs().maxCoeff() < 4.1;
    });
    ASSERT_EQ(parts.size(), 1U);
    const Ring& ring = parts[0][0];
    for (const double x : {-4.1, 4.1})
      for (const double y : {-4.1, 4.1}) {
        const Eigen::Vector2d corner = kCentre + Eigen::Rotation2Dd(turn) * Eigen::Vector2d(x, y);
        double nearest = 1;
        for (const Eigen::Vector2d& place : ring)
          nearest = std::min(nearest, (place - corner).norm());
        // The nearest corner of the ring is at most a side of such a square away.
        EXPECT_LT(nearest, kStep / 2 + kStep / 100);
      }
  }
}

TEST(RegionOutlines, OfNothing) {
  EXPECT_TRUE(
      region_outlines(grid_around(3), [](const Eigen::Vector2d&) { return false; }).empty());
  EXPECT_TRUE(region_outlines({}, [](const Eigen::Vector2d&) { return true; }).empty());
}

}  // namespace
}  // namespace axial::geometry
