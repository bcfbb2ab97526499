// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/terrain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/error.h"
#include "simulate/presets/presets.h"
#include "simulate/render.h"

namespace axial::simulate {
namespace {

// z-depths, and upward components of the normals in the world, of all views in one medium.
struct ViewStatistics {
  std::size_t background = 0;
  std::vector<double> depths;
  std::size_t facing_down = 0;
  std::size_t views = 0;

  double quantile(double q) const {
    return depths[static_cast<std::size_t>(q * static_cast<double>(depths.size() - 1))];
  }
};

ViewStatistics statistics_of_views(const std::string& name, bool water) {
  Preset preset = make_preset({name, 1, 0, 64, 48, 80});
  preset.terrain.cell *= 6;
  const RayScene scene(terrain_mesh(preset.terrain));
  const Port* port = water ? &preset.port : nullptr;
  ViewStatistics statistics;
  statistics.views = preset.views.size();
  for (const View& view : preset.views) {
    const Truth truth = render_truth(scene, preset.lens, port, view);
    for (int y = 0; y < preset.lens.height; ++y) {
      for (int x = 0; x < preset.lens.width; ++x) {
        const double distance = truth.distance(y, x);
        if (!(distance > 0)) {
          ++statistics.background;
          continue;
        }
        const auto ray = *trace_pixel(preset.lens, port, x, y);
        statistics.depths.push_back((ray.on_axis + distance * ray.direction).z());
        if (truth.normal(y, x)[2] < -0.1f) ++statistics.facing_down;
      }
    }
  }
  std::sort(statistics.depths.begin(), statistics.depths.end());
  return statistics;
}

TEST(Terrain, ReefIsWhereTheSpecificationPutsIt) {
  for (const bool water : {false, true}) {
    const ViewStatistics statistics = statistics_of_views("reef", water);
    EXPECT_EQ(statistics.views, 10u);
    EXPECT_EQ(statistics.background, 0u);
    EXPECT_GT(statistics.quantile(0.001), 2.0);
    EXPECT_LT(statistics.quantile(0.999), 3.5);
    // The relief is 30 to 50 % of the viewing distance.
    const double relief =
        (statistics.quantile(0.999) - statistics.quantile(0.001)) / statistics.quantile(0.5);
    EXPECT_GT(relief, 0.3);
    EXPECT_LT(relief, 0.5);
  }
}

TEST(Terrain, CloseupIsWhereTheSpecificationPutsIt) {
  const ViewStatistics statistics = statistics_of_views("closeup", false);
  EXPECT_EQ(statistics.views, 12u);
  EXPECT_EQ(statistics.background, 0u);
  EXPECT_GT(statistics.quantile(0.02), 0.45);
  EXPECT_GT(statistics.quantile(0.5), 0.70);
  EXPECT_LT(statistics.quantile(0.5), 0.80);
  // Views from the side see, beyond the object, the far wall of its hollow.
  EXPECT_LT(statistics.quantile(0.8), 0.90);
  EXPECT_LT(statistics.quantile(0.999), 1.1);
  // Overhangs must be visible: more than one pixel in a thousand.
  EXPECT_GT(1000 * statistics.facing_down, statistics.depths.size());
}

TEST(Terrain, SurveyGrowsWithItsViewsButEachSeesAsMuch) {
  for (const int views : {20, 50}) {
    Preset preset = make_preset({"survey", 1, views, 64, 48, 80});
    ASSERT_EQ(preset.views.size(), static_cast<std::size_t>(views));
    preset.terrain.cell *= 6;
    const RayScene scene(terrain_mesh(preset.terrain));
    for (const std::size_t i : {std::size_t{0}, preset.views.size() / 2, preset.views.size() - 1}) {
      const Truth truth = render_truth(scene, preset.lens, nullptr, preset.views[i]);
      for (const float distance : truth.distance) ASSERT_GT(distance, 1.5f);  // no background
    }
    // There are ten views in a row, 0.9 m apart up to a random 0.12 m. The next row starts above
    // the last view and runs back.
    for (const std::size_t i : {0u, 8u, 9u, 10u}) {
      const double step = (preset.views[i + 1].centre - preset.views[i].centre).norm();
      EXPECT_NEAR(step, 0.9, 0.3) << i;
    }
    EXPECT_NEAR(preset.views[10].centre.x(), preset.views[9].centre.x(), 0.13);
  }
}

TEST(Terrain, OutcropFillsTheViewsAtAFewMetres) {
  for (const bool water : {false, true}) {
    const ViewStatistics statistics = statistics_of_views("outcrop", water);
    EXPECT_EQ(statistics.views, 10u);
    EXPECT_EQ(statistics.background, 0u);
    EXPECT_GT(statistics.quantile(0.02), 1.2);
    EXPECT_GT(statistics.quantile(0.5), 1.8);
    EXPECT_LT(statistics.quantile(0.5), 3.2);
  }
}

// A slope of 0.5 without relief of its own, in layers of 10 cm that dip by 0.25.
TEST(Terrain, LayersMakeLedges) {
  Floor floor{
      .seed = 3, .wavelength = 1, .height = 0, .bowl_from = 0, .bowl_to = 1, .bowl_height = 0};
  EXPECT_EQ(floor.at(0.3, 0.4), 0);
  floor.layer = 0.1;
  floor.dip = {0.25, 0};
  double last = -1, steepest = 0, flattest = 1;
  for (int i = 0; i <= 4000; ++i) {
    const double x = 1e-3 * i;
    // The height above the bedding, which falls by 0.25 along x.
    const double height = floor.at(x, 0.7) + 0.25 * x;
    EXPECT_LE(std::abs(height - 0.25 * x), 0.1) << "a ledge is no higher than a layer";
    if (i > 0) {
      EXPECT_GE(height, last) << x;
      steepest = std::max(steepest, (height - last) / 1e-3);
      flattest = std::min(flattest, (height - last) / 1e-3);
    }
    last = height;
  }
  EXPECT_GT(steepest, 3 * 0.25);
  EXPECT_LT(flattest, 0.3 * 0.25);
}

TEST(Terrain, ScaleAndReliefStretchTheMeshAndNotThePort) {
  PresetOptions options;
  options.name = "closeup";
  options.coarseness = 8;
  const Preset plain = make_preset(options);
  options.scale = 2;
  const Preset large = make_preset(options);
  options.scale = 1;
  options.relief = 3;
  const Preset high = make_preset(options);
  const TriangleMesh a = terrain_mesh(plain.terrain), b = terrain_mesh(large.terrain),
                     c = terrain_mesh(high.terrain);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  ASSERT_EQ(a.vertices.size(), c.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    EXPECT_LT((2 * a.vertices[i] - b.vertices[i]).norm(), 1e-5);  // metres, float
    EXPECT_EQ(a.vertices[i].x(), c.vertices[i].x());
    EXPECT_FLOAT_EQ(3 * a.vertices[i].z(), c.vertices[i].z());
  }
  EXPECT_EQ(large.port.distance, plain.port.distance);
  EXPECT_LT((large.views[4].centre - 2 * plain.views[4].centre).norm(), 1e-12);
  EXPECT_EQ(high.views[4].centre, plain.views[4].centre);
  options.relief = 0;
  EXPECT_THROW(make_preset(options), Error);
}

TEST(Terrain, HasOverhangs) {
  for (const char* name : {"reef", "closeup"}) {
    Preset preset = make_preset({name, 1, 0, 64, 48, 80});
    preset.terrain.cell *= 6;
    const TriangleMesh mesh = terrain_mesh(preset.terrain);
    std::size_t facing_down = 0;
    for (const Eigen::Vector3f& n : vertex_normals(mesh)) facing_down += n.z() < -0.3f;
    EXPECT_GT(100 * facing_down, mesh.vertices.size()) << name;
  }
}

TEST(Terrain, SeedsGiveDifferentScenes) {
  const auto height = [](std::uint32_t seed) {
    return make_preset({"reef", seed, 0, 64, 48, 80}).terrain.floor.at(0.3, 0.4);
  };
  EXPECT_NE(height(1), height(2));
  EXPECT_EQ(height(1), height(1));
}

TEST(Terrain, RefusesUnknownPresets) {
  EXPECT_THROW(make_preset({"lake", 1, 0, 64, 48, 80}), Error);
  EXPECT_THROW(make_preset({"reef", 1, -1, 64, 48, 80}), Error);
  EXPECT_THROW(make_preset({"reef", 1, 0, 0, 48, 80}), Error);
}

TEST(TriangleMesh, SphereIsClosedAndFacesOutwards) {
  const TriangleMesh sphere = unit_sphere(3);
  EXPECT_EQ(sphere.faces.size(), 20u * 64u);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const auto& [a, b, c] : sphere.faces) {
    ++directed[{a, b}], ++directed[{b, c}], ++directed[{c, a}];
  }
  // The mesh is closed and consistently oriented: each edge occurs once in each direction.
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(directed.count({edge.second, edge.first}), 1u);
  }
  const auto normals = vertex_normals(sphere);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_GT(normals[i].dot(sphere.vertices[i]), 0.99f);
}

TEST(TriangleMesh, RemovesHiddenFacesAndTheirVertices) {
  TriangleMesh sphere = unit_sphere(2);
  remove_hidden(sphere, [](const Eigen::Vector3d& p) { return p.z() < 0; });
  EXPECT_GT(sphere.faces.size(), 160u);  // the upper half and the faces across the equator
  EXPECT_LT(sphere.faces.size(), 220u);
  std::vector<bool> used(sphere.vertices.size());
  for (const Face& face : sphere.faces)
    for (const std::uint32_t corner : face) used.at(corner) = true;
  EXPECT_THAT(used, testing::Each(true));
}

TEST(Blob, ContainsWhatLiesInsideItsMesh) {
  Blob blob;
  blob.centre = {1, 2, 3};
  blob.radii = {0.5, 0.4, 0.3};
  blob.roughness = 0.3;
  for (const Eigen::Vector3f& vertex : blob_mesh(blob, 0.05).vertices) {
    const Eigen::Vector3d p = vertex.cast<double>();
    EXPECT_TRUE(blob.contains(blob.centre + 0.99 * (p - blob.centre), 0));
    EXPECT_FALSE(blob.contains(blob.centre + 1.01 * (p - blob.centre), 0));
  }
}

}  // namespace
}  // namespace axial::simulate
