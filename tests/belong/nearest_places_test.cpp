// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/nearest_places.h"

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"
#include "geometry/triangle_distance.h"
#include "hilly_scene.h"

namespace axial::belong {
namespace {

std::vector<Eigen::Vector3d> some_places() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 200; ++i) places.emplace_back(at(random), at(random), 1 + 0.3 * at(random));
  return places;
}

// The oracle: all parts, one after the other.
double distance_to(const Shape& shape, const Eigen::Vector3d& place) {
  double nearest = 1e9;
  const auto at = [&](std::size_t i) { return Eigen::Vector3d(shape.vertices[i].cast<double>()); };
  for (std::size_t part = 0; part < shape.parts(); ++part) {
    Eigen::Vector3d point = shape.middle(part);
    if (!shape.faces.empty()) {
      const auto& [a, b, c] = shape.faces[part];
      point = geometry::closest_on_triangle(place, {at(a), at(b), at(c)});
    }
    nearest = std::min(nearest, (point - place).norm());
  }
  return nearest;
}

void expect_nearest(const Shape& shape, double reach) {
  const std::vector<Eigen::Vector3d> places = some_places();
  const auto nearest = nearest_places(shape, places, reach);
  std::size_t found = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = distance_to(shape, places[i]);
    ASSERT_EQ(nearest[i].has_value(), distance < reach) << i;
    if (!nearest[i]) continue;
    ++found;
    EXPECT_NEAR((*nearest[i] - places[i]).norm(), distance, 1e-12) << i;
  }
  EXPECT_GT(found, 20u);
  EXPECT_LT(found, places.size());
}

TEST(NearestPlaces, AreThoseOfAllFacesAndPoints) {
  const Mesh fine = test::ground(0, 30), coarse = test::ground(0, 3);
  for (const double reach : {0.1, 0.2}) {
    expect_nearest(shape_of(fine), reach);
    expect_nearest(shape_of(coarse), reach);
    expect_nearest({fine.vertices}, reach);
  }
}

TEST(NearestPlaces, OfHugeFacesAreFound) {
  Mesh mesh;
  mesh.vertices = {{-1e6f, -1e6f, 1}, {1e6f, -1e6f, 1}, {0, 2e6f, 1}};
  mesh.faces = {{0, 1, 2}};
  const auto nearest =
      nearest_places(shape_of(mesh), std::vector{Eigen::Vector3d(0.3, 0.2, 1.05)}, 0.1);
  ASSERT_TRUE(nearest[0]);
  EXPECT_NEAR((*nearest[0] - Eigen::Vector3d(0.3, 0.2, 1)).norm(), 0, 1e-6);
}

TEST(NearestPlaces, DoNotDependOnThreads) {
  const Mesh mesh = test::ground(0, 40);
  const auto nearest_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return nearest_places(shape_of(mesh), some_places(), 0.2);
  };
  EXPECT_EQ(nearest_with(1), nearest_with(4));
}

}  // namespace
}  // namespace axial::belong
