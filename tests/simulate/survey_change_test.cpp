// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the stated change of a second survey with vertical rays at the meshes of both surveys.
#include "simulate/presets/survey_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "simulate/ray_scene.h"

namespace axial::simulate {
namespace {

Preset reef(std::uint32_t seed, bool changed, double scale = 1, double relief = 1) {
  PresetOptions options;
  options.seed = seed;
  options.changed = changed;
  options.scale = scale;
  options.relief = relief;
  return make_preset(options);
}

// The mesh of the middle of the scene, where the changes are.
TriangleMesh middle(const Preset& preset, double scale) {
  Terrain terrain = preset.terrain;
  terrain.half_width = 2.5 * scale;
  terrain.half_height = 2 * scale;
  terrain.skirt = 0.1 * scale;
  return terrain_mesh(terrain);
}

// Volumes and areas of what rose and of what sank within a part of the map.
struct Change {
  double came = 0, gone = 0, area = 0;
};

class Rays {
 public:
  Rays(const Preset& before, const Preset& after, double scale)
      : before_(middle(before, scale)), after_(middle(after, scale)) {}

  double rise(double x, double y) const {
    const Eigen::Vector3d from(x, y, 50);
    const auto high = before_.first_hit(from, -Eigen::Vector3d::UnitZ());
    const auto low = after_.first_hit(from, -Eigen::Vector3d::UnitZ());
    return high.value().distance - low.value().distance;
  }

  // The change in the rectangle around `centre` with half the sides `half`, at squares of `step`.
  Change in(const Eigen::Vector2d& centre, const Eigen::Vector2d& half, double step) const {
    Change change;
    for (double x = -half.x() + step / 2; x < half.x(); x += step)
      for (double y = -half.y() + step / 2; y < half.y(); y += step) {
        const double by = rise(centre.x() + x, centre.y() + y);
        (by > 0 ? change.came : change.gone) += std::abs(by) * step * step;
        if (std::abs(by) > 1e-5) change.area += step * step;
      }
    return change;
  }

 private:
  RayScene before_, after_;
};

void expect_near(double found, double expected, double share) {
  EXPECT_NEAR(found, expected, share * expected);
}

// The meshes have a vertex every 10 mm and cut off a little of the boulder.
void compare(const Preset& before, const Preset& after, double scale) {
  const ChangeTruth truth = true_change(after);
  const Rays rays(before, after, scale);
  const double reach = 2 * after.terrain.blobs[after.moved->blob].radii.maxCoeff();
  const double step = 0.008 * scale;
  const Change gone = rays.in(after.moved->from.head<2>(), {reach, reach}, step);
  const Change came = rays.in(truth.came.place, {reach, reach}, step);
  const Growth& growth = after.terrain.growth;
  const Eigen::Vector2d half = growth.half.array() + growth.edge;
  const Change patch = rays.in(growth.centre, half, step);
  expect_near(gone.gone, truth.gone.volume, 0.02);
  expect_near(came.came, truth.came.volume, 0.02);
  expect_near(patch.came, truth.patch.volume, 0.005);
  expect_near(patch.area, truth.patch.area, 0.05);
  const Change all = rays.in({0, 0}, Eigen::Vector2d(2.4, 1.9) * scale, 0.013 * scale);
  expect_near(all.gone, truth.gone.volume, 0.03);
  expect_near(all.came, truth.came.volume + truth.patch.volume, 0.03);
  expect_near(all.area, truth.gone.area + truth.came.area + truth.patch.area, 0.05);
}

TEST(SurveyChange, HasTheVolumesThatVerticalRaysFind) {
  compare(reef(41, false), reef(41, true), 1);
}

TEST(SurveyChange, GrowsWithTheSceneAndItsRelief) {
  compare(reef(5, false, 2, 0.7), reef(5, true, 2, 0.7), 2);
}

TEST(SurveyChange, IsNearTheMiddleAndItsPartsAreApart) {
  int without_boulder = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::optional<Preset> changed;
    try {
      changed = reef(seed, true);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("choose another seed"));
      ++without_boulder;
      continue;
    }
    const Preset& after = *changed;
    const Terrain& terrain = after.terrain;
    const Blob& boulder = terrain.blobs[after.moved->blob];
    const Eigen::Vector2d from = after.moved->from.head<2>(), to = boulder.centre.head<2>();
    const double radius = boulder.radii.head<2>().maxCoeff();
    EXPECT_GT((from - to).norm(), 2 * radius);
    for (const Eigen::Vector2d& place : {from, to}) {
      const Eigen::Vector2d beyond =
          ((place - terrain.growth.centre).cwiseAbs() - terrain.growth.half).cwiseMax(0);
      EXPECT_GT(beyond.norm(), radius);
      EXPECT_LT(place.cwiseAbs().x(), 1.6);
      EXPECT_LT(place.cwiseAbs().y(), 1.0);
    }
    EXPECT_GT(radius, 0.12);
  }
  EXPECT_LT(without_boulder, 20);
}

TEST(SurveyChange, LeavesEverythingElseAndTakesOtherViews) {
  const Preset before = reef(42, false), after = reef(42, true);
  ASSERT_EQ(before.terrain.blobs.size(), after.terrain.blobs.size());
  for (std::size_t i = 0; i < before.terrain.blobs.size(); ++i)
    EXPECT_EQ(before.terrain.blobs[i].centre == after.terrain.blobs[i].centre,
              i != after.moved->blob);
  EXPECT_EQ(before.terrain.blobs[after.moved->blob].centre, after.moved->from);
  EXPECT_EQ(before.terrain.growth.height, 0);
  EXPECT_FALSE(before.moved);
  ASSERT_EQ(before.views.size(), after.views.size());
  for (const View& one : before.views)
    for (const View& other : after.views) EXPECT_GT((one.centre - other.centre).norm(), 0.05);
  PresetOptions options;
  options.changed = true;
  options.name = "sand";
  EXPECT_THROW(make_preset(options), Error);
}

}  // namespace
}  // namespace axial::simulate
