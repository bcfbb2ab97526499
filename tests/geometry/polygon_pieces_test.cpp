// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon_pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/rings.h"

namespace axial::geometry {
namespace {

using test::is_inside;
using test::star;

double area_of(std::span<const Eigen::Vector3d> corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k)
    sum += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  return sum.norm() / 2;
}

TEST(PolygonPieces, RingsHaveSignedAreas) {
  Ring ring{{0, 0}, {4, 0}, {4, 3}, {1, 1}, {0, 3}};
  EXPECT_EQ(signed_area(ring), 8);
  std::ranges::reverse(ring);
  EXPECT_EQ(signed_area(ring), -8);
  for (Eigen::Vector2d& corner : ring) corner += Eigen::Vector2d(5e5, 5e6);
  EXPECT_EQ(signed_area(ring), -8);
  EXPECT_EQ(signed_area({}), 0);
}

TEST(PolygonPieces, HaveTheAreaOfRingsWithoutHoles) {
  const std::vector<Ring> rings{star({0, 0}, 1, 2, 7), star({0.1, 0.1}, 0.3, 0.5, 5),
                                star({6, 1}, 0.5, 1, 3)};
  EXPECT_FALSE(crossing_of(rings));
  EXPECT_NEAR(PolygonPieces(rings).area(),
              signed_area(rings[0]) - signed_area(rings[1]) + signed_area(rings[2]), 1e-12);
}

TEST(PolygonPieces, ContainThePointsInAnOddNumberOfRings) {
  const std::vector<Ring> rings{star({0, 0}, 1, 2, 7), star({0.1, 0.1}, 0.3, 0.5, 5),
                                star({6, 1}, 0.5, 1, 3)};
  const PolygonPieces pieces(rings);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-3, 8), y(-3, 3);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d place(x(random), y(random));
    int count = 0;
    for (const Ring& ring : rings) count += is_inside(ring, place);
    EXPECT_EQ(pieces.contains(place), count % 2 == 1) << place.transpose();
  }
}

// The parts of random triangles in a square, also of upright ones, against sums over many points.
TEST(PolygonPieces, ClipTriangles) {
  const std::vector<Ring> rings{star({0, 0}, 1, 2, 7), star({0.1, 0.1}, 0.3, 0.5, 5)};
  const PolygonPieces pieces(rings);
  PolygonPieces::Scratch scratch;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-2.5, 2.5);
  for (int i = 0; i < 30; ++i) {
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners)
      corner = {uniform(random), uniform(random), uniform(random)};
    if (i % 3 == 0) corners[2].head<2>() = corners[0].head<2>();  // upright
    double area = 0;
    pieces.clip(corners, scratch,
                [&](std::span<const Eigen::Vector3d> part) { area += area_of(part); });
    constexpr int kSteps = 400;
    int inside = 0, all = 0;
    for (int u = 0; u < kSteps; ++u)
      for (int v = 0; u + v < kSteps; ++v) {
        const double a = (u + 1.0 / 3) / kSteps, b = (v + 1.0 / 3) / kSteps;
        const Eigen::Vector3d place =
            corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
        ++all;
        inside += is_inside(rings[0], place.head<2>()) != is_inside(rings[1], place.head<2>());
      }
    // Of 80,000 points, up to 6 * 400 lie in squares at the rim; their errors of either sign cancel
    // but for about their square root, 50, and those of long edges along the steps.
    EXPECT_NEAR(area / area_of(corners), static_cast<double>(inside) / all, 0.01) << i;
  }
}

TEST(PolygonPieces, SharedEdgesAreClippedOnce) {
  const std::vector<Ring> rings{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}};
  const PolygonPieces pieces(rings);
  PolygonPieces::Scratch scratch;
  double area = 0;
  const auto add = [&](std::span<const Eigen::Vector3d> part) { area += area_of(part); };
  pieces.clip({{{0, 0, 1}, {2, 0, 1}, {2, 2, 1}}}, scratch, add);
  pieces.clip({{{0, 0, 1}, {2, 2, 1}, {0, 2, 1}}}, scratch, add);
  EXPECT_NEAR(area, 4, 1e-12);
  pieces.clip({{{4, 0, 0}, {6, 0, 0}, {6, 2, 0}}}, scratch, add);
  EXPECT_NEAR(area, 4, 1e-12);
}

TEST(PolygonPieces, CrossingsAreFound) {
  const std::vector<Ring> bow{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}};
  const auto found = crossing_of(bow);
  ASSERT_TRUE(found);
  EXPECT_NEAR((*found - Eigen::Vector2d(1, 1)).norm(), 0, 1e-12);
  const std::vector<Ring> along{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{1, 0}, {3, 0}, {3, -1}}};
  EXPECT_TRUE(crossing_of(along));
  // A hole whose corner is on an edge of the outer ring, up to the rounding of UTM.
  const Eigen::Vector2d utm(500000.1, 5000000.3);
  const std::vector<Ring> hole{{utm, utm + Eigen::Vector2d(1, 0.3), utm + Eigen::Vector2d(0.4, 1)},
                               {utm + Eigen::Vector2d(0.5, 0.15 - 2e-9),
                                utm + Eigen::Vector2d(0.6, 0.3), utm + Eigen::Vector2d(0.45, 0.3)}};
  EXPECT_FALSE(crossing_of(hole));
  const std::vector<Ring> touching{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{2, 2}, {3, 2}, {3, 3}}};
  EXPECT_FALSE(crossing_of(touching));
}

}  // namespace
}  // namespace axial::geometry
