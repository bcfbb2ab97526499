// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tetrahedra.h"

#include <Eigen/Geometry>
#include <random>
#include <set>

#include "base/error.h"
#include "mesh/facet_quality.h"
#include "mesh/merge_points.h"
#include "mesh/ray_walk.h"
#include "support/error_of.h"

namespace axial::mesh {
namespace {

using test::error_of;

std::vector<Eigen::Vector3f> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> in_cube(-1, 1);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& point : points) point = {in_cube(random), in_cube(random), in_cube(random)};
  return points;
}

Eigen::Vector3d corner(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                       std::size_t cell, std::size_t i) {
  return points[tetrahedra.corners[cell][i]].cast<double>();
}

double signed_volume(const Tetrahedra& t, std::span<const Eigen::Vector3f> points,
                     std::size_t cell) {
  const Eigen::Vector3d a = corner(t, points, cell, 0);
  return (corner(t, points, cell, 1) - a)
             .cross(corner(t, points, cell, 2) - a)
             .dot(corner(t, points, cell, 3) - a) /
         6;
}

TEST(Tetrahedra, NeighboursNameEachOtherAndShareAFacet) {
  const std::vector<Eigen::Vector3f> points = random_points(300, 1);
  const Tetrahedra t = delaunay(points);
  for (std::uint32_t cell = 0; cell < t.size(); ++cell)
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t next = t.neighbours[cell][i];
      const int back = t.place_of_neighbour(next, cell);
      ASSERT_EQ(t.neighbours[next][static_cast<std::size_t>(back)], cell);
      std::set<std::uint32_t> here(t.corners[cell].begin(), t.corners[cell].end()),
          there(t.corners[next].begin(), t.corners[next].end());
      here.erase(t.corners[cell][i]);
      there.erase(t.corners[next][static_cast<std::size_t>(back)]);
      ASSERT_EQ(here, there);
    }
}

TEST(Tetrahedra, AreDelaunayPositiveAndFillTheCube) {
  std::vector<Eigen::Vector3f> points = random_points(200, 2);
  for (int k = 0; k < 8; ++k)
    points.emplace_back(k & 1 ? 1.f : -1.f, k & 2 ? 1.f : -1.f, k & 4 ? 1.f : -1.f);
  const Tetrahedra t = delaunay(points);
  double volume = 0;
  for (std::size_t cell = 0; cell < t.size(); ++cell) {
    if (t.infinite(cell)) continue;
    const double own = signed_volume(t, points, cell);
    EXPECT_GT(own, 0);
    volume += own;
    // No other point is in the circumsphere.
    Eigen::Matrix3d rows;
    Eigen::Vector3d squares;
    const Eigen::Vector3d a = corner(t, points, cell, 0);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d side = corner(t, points, cell, static_cast<std::size_t>(k) + 1) - a;
      rows.row(k) = 2 * side.transpose();
      squares[k] = side.squaredNorm();
    }
    const Eigen::Vector3d centre = rows.inverse() * squares;
    for (const Eigen::Vector3f& p : points)
      ASSERT_GT((p.cast<double>() - a - centre).norm(), centre.norm() * (1 - 1e-6));
  }
  EXPECT_NEAR(volume, 8, 1e-9);
}

TEST(Tetrahedra, RefuseAPlane) {
  std::vector<Eigen::Vector3f> points = random_points(50, 3);
  for (Eigen::Vector3f& point : points) point.z() = 0;
  EXPECT_THAT(error_of([&] { delaunay(points); }), testing::HasSubstr("plane"));
}

// Brute force: the tetrahedra that a segment crosses are those that contain one of many samples.
TEST(RayWalk, VisitsTheTetrahedraAlongTheRayInTheirOrder) {
  const std::vector<Eigen::Vector3f> points = random_points(150, 4);
  const Tetrahedra t = delaunay(points);
  const Stars stars = stars_of(t, points.size());
  const auto contains = [&](std::size_t cell, const Eigen::Vector3d& x) {
    Eigen::Matrix3d sides;
    const Eigen::Vector3d a = corner(t, points, cell, 0);
    for (int k = 0; k < 3; ++k)
      sides.col(k) = corner(t, points, cell, static_cast<std::size_t>(k) + 1) - a;
    const Eigen::Vector3d weights = sides.inverse() * (x - a);
    return weights.minCoeff() > 1e-9 && weights.sum() < 1 - 1e-9;
  };
  for (std::uint32_t start = 0; start < 40; start += 4) {
    const Eigen::Vector3d from = points[start].cast<double>(),
                          to = 0.3 * points[start + 50].cast<double>();
    const double length = (to - from).norm();
    std::vector<std::uint32_t> visited;
    double last_distance = 0;
    const std::uint32_t end =
        walk(t, points, stars, start, (to - from) / length, length, [&](const Crossing& crossing) {
          if (visited.empty()) visited.push_back(crossing.from);
          EXPECT_EQ(visited.back(), crossing.from);
          EXPECT_GE(crossing.distance, last_distance);
          last_distance = crossing.distance;
          visited.push_back(crossing.to);
        });
    if (visited.empty()) visited.push_back(end);
    EXPECT_EQ(visited.back(), end);
    std::vector<std::uint32_t> sampled;
    for (int k = 1; k < 2000; ++k) {
      const Eigen::Vector3d x = from + (to - from) * (k / 2000.0);
      for (std::uint32_t cell = 0; cell < t.size(); ++cell)
        if (!t.infinite(cell) && contains(cell, x) && (sampled.empty() || sampled.back() != cell))
          sampled.push_back(cell);
    }
    // Samples may miss a tetrahedron that the ray only grazes.
    auto next = visited.begin();
    for (const std::uint32_t cell : sampled) {
      next = std::find(next, visited.end(), cell);
      ASSERT_NE(next, visited.end()) << "start " << start;
    }
    EXPECT_LE(visited.size(), sampled.size() + 3);
  }
}

TEST(RayWalk, LeavesTheHull) {
  const std::vector<Eigen::Vector3f> points = random_points(100, 5);
  const Tetrahedra t = delaunay(points);
  const Stars stars = stars_of(t, points.size());
  for (std::uint32_t start = 0; start < 100; ++start) {
    const Eigen::Vector3d direction = points[start].cast<double>().normalized();
    const std::uint32_t end = walk(t, points, stars, start, direction, 10, [](const Crossing&) {});
    ASSERT_TRUE(t.infinite(end));
    // The facet of the hull through which the ray leaves faces the direction.
    const auto at = static_cast<std::size_t>(t.place(end, Tetrahedra::kInfinity));
    const std::uint32_t inner = t.neighbours[end][at];
    const auto back = static_cast<std::size_t>(t.place_of_neighbour(inner, end));
    const Eigen::Vector3d a = corner(t, points, inner, (back + 1) & 3),
                          b = corner(t, points, inner, (back + 2) & 3),
                          c = corner(t, points, inner, (back + 3) & 3);
    Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.dot(corner(t, points, inner, back) - a) > 0) normal = -normal;
    EXPECT_GT(normal.dot(direction), 0) << start;
  }
}

TEST(FacetQuality, RegularTetrahedraCostTheCosineOfTheirSpheres) {
  // Two regular tetrahedra at a common facet. The circumcentre is r away from the corners and r / 3
  // from the facets.
  const float h = std::sqrt(2.f / 3);
  const std::vector<Eigen::Vector3f> points{{0, 0, 0},
                                            {1, 0, 0},
                                            {0.5f, std::sqrt(0.75f), 0},
                                            {0.5f, std::sqrt(0.75f) / 3, h},
                                            {0.5f, std::sqrt(0.75f) / 3, -h}};
  const Tetrahedra t = delaunay(points);
  int found = 0;
  for (std::uint32_t cell = 0; cell < t.size(); ++cell)
    for (std::size_t i = 0; i < 4; ++i) {
      if (t.infinite(cell) || t.infinite(t.neighbours[cell][i])) continue;
      EXPECT_NEAR(shape_cost(t, points, cell, i), 1 - 1.0 / 3, 1e-6);
      ++found;
    }
  EXPECT_EQ(found, 2);
}

TEST(SpatialOrder, IsAPermutationWithShortSteps) {
  const std::vector<Eigen::Vector3f> points = random_points(4000, 6);
  const std::vector<std::uint32_t> order = spatial_order(points);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), points.size());
  double given = 0, sorted = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    given += static_cast<double>((points[i] - points[i - 1]).norm());
    sorted += static_cast<double>((points[order[i]] - points[order[i - 1]]).norm());
  }
  // The mean distance of random points in the cube is 1.3; of neighbours on the curve about the
  // spacing of the points, 0.13, times less than two.
  EXPECT_LT(sorted, given / 4);
}

}  // namespace
}  // namespace axial::mesh
