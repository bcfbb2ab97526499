// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "evaluate/shapes.h"
#include "geometry/sampling.h"
#include "geometry/triangle_distance.h"

namespace axial::geometry {
namespace {

using namespace evaluate;  // shapes

using Triangle = std::array<Eigen::Vector3d, 3>;

// The distance to the nearest of a fine grid of points of the triangle. It is never below the true
// distance, and exceeds it by at most the step of the grid.
double gridded_distance(const Eigen::Vector3d& p, const Triangle& t, int steps) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps, v = static_cast<double>(j) / steps;
      best = std::min(best, ((1 - u - v) * t[0] + u * t[1] + v * t[2] - p).norm());
    }
  return best;
}

TEST(TriangleDistance, IsTheLeastOverAllPointsOfTheTriangle) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    Triangle t{random_vector(random, 1), random_vector(random, 1), random_vector(random, 1)};
    if (trial % 5 == 0) t[2] = 0.3 * t[0] + 0.7 * t[1];  // no area
    if (trial % 25 == 0) t[1] = t[2] = t[0];             // a point
    const Eigen::Vector3d p = random_vector(random, 2);
    const Eigen::Vector3d closest = closest_on_triangle(p, t);
    const double exact = (closest - p).norm();
    const double gridded = gridded_distance(p, t, 120);
    EXPECT_LE(exact, gridded + 1e-12) << trial;
    // Sides are at most 2 sqrt(3) long, and a grid point is within a step of the closest point.
    EXPECT_GE(exact, gridded - 2 * 3.47 / 120) << trial;
    // The closest point is on the triangle, so its own distance is 0.
    EXPECT_LT((closest_on_triangle(closest, t) - closest).norm(), 1e-12) << trial;
  }
}

TEST(TriangleDistance, OfKnownRegions) {
  const Triangle t{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
  EXPECT_DOUBLE_EQ((closest_on_triangle({0.2, 0.2, -3}, t) - Eigen::Vector3d(0.2, 0.2, 0)).norm(),
                   0);
  EXPECT_DOUBLE_EQ((closest_on_triangle({-1, -1, 1}, t) - t[0]).norm(), 0);
  EXPECT_DOUBLE_EQ((closest_on_triangle({3, -1, 1}, t) - t[1]).norm(), 0);
  EXPECT_DOUBLE_EQ((closest_on_triangle({0.5, -2, 0}, t) - Eigen::Vector3d(0.5, 0, 0)).norm(), 0);
  EXPECT_NEAR((closest_on_triangle({1, 1, 0}, t) - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 0, 1e-15);
}

double brute_force(const Mesh& mesh, const Eigen::Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& f : mesh.faces)
    best = std::min(best, (closest_on_triangle(p, {mesh.vertices[f[0]].cast<double>(),
                                                   mesh.vertices[f[1]].cast<double>(),
                                                   mesh.vertices[f[2]].cast<double>()}) -
                           p)
                              .norm());
  return best;
}

TEST(Surface, DistancesAgreeWithBruteForce) {
  // Also far from the origin, where the hierarchy's float boxes are coarsest.
  for (const double offset : {0.0, 30.0}) {
    Mesh mesh = height_field(40, 2, ripples);
    for (auto& v : mesh.vertices) v += Eigen::Vector3f::Constant(static_cast<float>(offset));
    const Surface surface(mesh);
    std::mt19937 random(3);
    for (int i = 0; i < 400; ++i) {
      Eigen::Vector3d p = random_vector(random, i % 2 ? 1.0 : 3.0);
      if (i % 4 == 0) p.z() = ripples(p.x(), p.y());  // close to the surface
      p += Eigen::Vector3d::Constant(offset);
      const ClosestPoint closest = surface.closest(p);
      // Both use the same arithmetic on the same triangles, so only the pruning can differ.
      EXPECT_NEAR(closest.distance, brute_force(mesh, p), 1e-12) << offset << " " << i;
      EXPECT_NEAR((closest.point - p).norm(), closest.distance, 1e-12);
    }
  }
}

TEST(Surface, DistancesDoNotDependOnThreads) {
  const Mesh mesh = height_field(60, 2, ripples);
  const Surface surface(mesh);
  const auto points = sample_surface(height_field(5, 2.2, ripples), 20000, 4);
  std::vector<float> alone;
  {
    const ThreadLimit one(1);
    alone = distances_to(surface, points);
  }
  const ThreadLimit four(4);
  EXPECT_EQ(distances_to(Surface(mesh), points), alone);
}

TEST(Surface, BlocksSightThroughTrianglesOnly) {
  const Surface surface(flat_square(2, 1));
  EXPECT_TRUE(surface.between({0.3, 0.2, 0}, {0.3, 0.2, 2}, 1e-4, 0));
  EXPECT_FALSE(surface.between({0.3, 0.2, 0}, {0.3, 0.2, 0.99}, 1e-4, 0));
  EXPECT_FALSE(surface.between({1.3, 0.2, 0}, {1.3, 0.2, 2}, 1e-4, 0));
  EXPECT_FALSE(surface.between({0.3, 0.2, 1}, {0.3, 0.4, 3}, 1e-4, 0))
      << "a point on it hides itself";
}

TEST(Surface, RefusesUnusableMeshes) {
  EXPECT_THROW(Surface(Mesh{}), Error);
  Mesh mesh = flat_square(1, 0);
  mesh.faces[0][1] = 4;
  EXPECT_THROW(Surface{mesh}, Error);
  mesh = flat_square(1, 0);
  mesh.vertices[2].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(Surface{mesh}, Error);
  mesh.vertices[2].y() = 1e20f;
  EXPECT_THROW(Surface{mesh}, Error);
}

TEST(Surface, NothingIsSeenFromBeyondTheLargestCoordinate) {
  const Surface surface(flat_square(2, 1));
  for (const double far : {1e20, 1e300}) {
    EXPECT_TRUE(surface.between({0.3, 0.2, 0}, {0.3, 0.2, -far}, 1e-4, 0));
    EXPECT_TRUE(surface.between({far, 0.2, 0}, {0.3, 0.2, 2}, 1e-4, 0));
    EXPECT_FALSE(surface.first_hit({0.3, 0.2, -far}, {0, 0, 1}));
  }
}

TEST(Sampling, IsUniformByArea) {
  // Two squares, the smaller with a ninth of the area of the larger, with very different numbers of
  // faces.
  Mesh mesh = height_field(30, 1, [](double, double) { return 0.0; });
  const Mesh large = flat_square(3, 5);
  test::append(mesh, large);
  const auto samples = sample_surface(mesh, 10000, 1);
  std::size_t low = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), spread = mean;
  for (const auto& x : samples) {
    if (x.z() < 1) {
      ++low;
      continue;
    }
    mean += x.cast<double>();
    spread += x.cast<double>().cwiseAbs2();
  }
  EXPECT_NEAR(static_cast<double>(low), 1000, 1);  // stratified: exact up to one sample
  mean /= 9000;
  spread /= 9000;
  // For a uniform distribution on [-1.5, 1.5] the standard error is 0.0091 for the mean and 0.0071
  // for the mean square.
  EXPECT_NEAR(mean.x(), 0, 0.03);
  EXPECT_NEAR(mean.y(), 0, 0.03);
  EXPECT_NEAR(spread.x(), 0.75, 0.025);
  EXPECT_NEAR(spread.y(), 0.75, 0.025);
  EXPECT_EQ(samples, sample_surface(mesh, 10000, 1));
  EXPECT_NE(samples, sample_surface(mesh, 10000, 2));
}

TEST(Sampling, RefusesAMeshWithoutArea) {
  Mesh mesh = flat_square(1, 0);
  for (auto& v : mesh.vertices) v.setZero();
  EXPECT_THROW(sample_surface(mesh, 10, 1), Error);
}

TEST(Sampling, SubsampleKeepsOrderAndSize) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(static_cast<float>(i), 0.0f, 0.0f);
  const auto few = subsample(points, 100, 1);
  ASSERT_EQ(few.size(), 100u);
  for (std::size_t i = 1; i < few.size(); ++i) EXPECT_GT(few[i].x(), few[i - 1].x());
  EXPECT_EQ(subsample(points, 2000, 1), points);
}

}  // namespace
}  // namespace axial::geometry
