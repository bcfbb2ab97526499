// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the thickness, overlap and contrast of presets with rays and pixels.
#include "simulate/presets/presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/error.h"
#include "simulate/render.h"
#include "simulate/solid_texture.h"

namespace axial::simulate {
namespace {

TEST(Tube, IsClosedRoundAndKnowsItsThickness) {
  const Tube tube{{{0, 0, 0}, {0.1, 0, 0.05}, {0.2, 0.05, 0.05}}, {0.004, 0.004, 0.004}};
  const TriangleMesh mesh = tube_mesh(tube, 0.001);
  ASSERT_EQ(mesh.thickness.size(), mesh.vertices.size());
  for (const float thickness : mesh.thickness) EXPECT_FLOAT_EQ(thickness, 0.008f);
  // By the divergence theorem the signed volume is positive if all faces point outwards.
  double volume = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d p = mesh.vertices[a].cast<double>(), q = mesh.vertices[b].cast<double>(),
                          r = mesh.vertices[c].cast<double>();
    volume += p.dot(q.cross(r)) / 6;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) ++edges[{from, to}];
  }
  const double length = std::sqrt(0.0125) + std::sqrt(0.0125);
  const double expected = std::numbers::pi * 0.004 * 0.004 * length;
  EXPECT_NEAR(volume, expected, 0.05 * expected) << "the bend and the facets";
  // Each edge has a face on both sides, except at the tips, which have holes a thousandth of the
  // tube wide.
  const auto alone = std::ranges::count_if(edges, [&](const auto& edge) {
    return edges.count({edge.first.second, edge.first.first}) == 0;
  });
  EXPECT_LE(alone, 2 * 48);
}

Preset small(const std::string& name, int width, int height, double cells,
             double overlap = PresetOptions{}.overlap) {
  PresetOptions options;
  options.name = name;
  options.seed = 3;
  options.width = width;
  options.height = height;
  options.coarseness = cells;
  options.overlap = overlap;
  return make_preset(options);
}

TEST(Thicket, HasStructuresFromOneToSixteenPixels) {
  const Preset preset = small("thicket", 1024, 768, 4);
  const TriangleMesh mesh = terrain_mesh(preset.terrain);
  ASSERT_EQ(mesh.thickness.size(), mesh.vertices.size());
  // Traces every eighth pixel and counts the hits on thin structures by their thickness in pixels.
  const RayScene scene(mesh);
  std::map<int, int> hits;  // keyed by the logarithm of the thickness in pixels
  int all = 0, below = 0;
  for (const View& view : preset.views) {
    for (int y = 0; y < preset.lens.height; y += 8)
      for (int x = 0; x < preset.lens.width; x += 8) {
        const auto in_camera = trace_pixel(preset.lens, &preset.port, x, y);
        ASSERT_TRUE(in_camera);
        const SceneRay ray = to_world(view, *in_camera);
        const auto hit = scene.first_hit(ray.start, ray.direction);
        ASSERT_TRUE(hit) << "no background";
        ++all;
        const auto& face = mesh.faces[hit->face];
        const double thickness = static_cast<double>(mesh.thickness[face[0]]);
        if (!(thickness > 0)) continue;
        const double pixel = hit->distance / (preset.lens.focal * preset.port.n_water);
        ++hits[static_cast<int>(std::lround(std::log2(thickness / pixel)))];
        // The structure stands above the ground if the ray continues for a while behind it.
        const Eigen::Vector3d behind =
            ray.start + (hit->distance + 1.2 * thickness) * ray.direction;
        const auto next = scene.first_hit(behind, ray.direction);
        if (next && next->distance > 0.03) ++below;
      }
  }
  for (const int logarithm : {0, 1, 2, 3, 4})
    EXPECT_GT(hits[logarithm], 30) << "2^" << logarithm << " px";
  int thin = 0;
  for (const auto& [logarithm, count] : hits) thin += count;
  EXPECT_GT(thin, all / 50);
  EXPECT_LT(thin, all / 2) << "the ground is seen as well";
  EXPECT_GT(below, thin / 3) << "most of it stands free of what is behind";
}

TEST(Thicket, WhatIsNotThinHasNoThickness) {
  const Preset preset = small("thicket", 64, 48, 8);
  Terrain bare = preset.terrain;
  bare.tubes.clear();
  const TriangleMesh with = terrain_mesh(preset.terrain), without = terrain_mesh(bare);
  EXPECT_TRUE(without.thickness.empty());
  ASSERT_GT(with.vertices.size(), without.vertices.size());
  for (std::size_t i = 0; i < without.vertices.size(); ++i) {
    ASSERT_EQ(with.vertices[i], without.vertices[i]);
    ASSERT_EQ(with.thickness[i], 0.0f);
  }
}

// Counts, for squares of the ground `cell` metres wide, the views with a ray that ends there.
std::map<std::pair<int, int>, int> views_of_ground(const Preset& preset, const RayScene& scene,
                                                   double cell) {
  std::map<std::pair<int, int>, int> counts;
  for (const View& view : preset.views) {
    std::set<std::pair<int, int>> seen;
    for (int y = 0; y < preset.lens.height; ++y)
      for (int x = 0; x < preset.lens.width; ++x) {
        const SceneRay ray = to_world(view, *trace_pixel(preset.lens, &preset.port, x, y));
        const auto hit = scene.first_hit(ray.start, ray.direction);
        if (!hit) continue;
        const Eigen::Vector3d at = ray.start + hit->distance * ray.direction;
        seen.insert({static_cast<int>(std::floor(at.x() / cell)),
                     static_cast<int>(std::floor(at.y() / cell))});
      }
    for (const auto& square : seen) ++counts[square];
  }
  return counts;
}

TEST(Transect, MostGroundIsSeenByExactlyTwo) {
  const Preset preset = small("transect", 128, 96, 6);
  ASSERT_EQ(preset.views.size(), 12u);
  const RayScene scene(terrain_mesh(preset.terrain));
  int two = 0, more = 0;
  for (const auto& [square, views] : views_of_ground(preset, scene, 0.08)) {
    two += views == 2;
    more += views > 2;
  }
  // In each 0.45 of a view's length along the strip, 0.35 is seen by two views and 0.1 by three.
  EXPECT_NEAR(static_cast<double>(two) / (two + more), 0.35 / 0.45, 0.08);
}

TEST(Transect, EveryViewOverlapsTheOneBeforeAsStated) {
  for (const double stated : {0.55, 0.7}) {
    const Preset preset = small("transect", 128, 96, 6, stated);
    const RayScene scene(terrain_mesh(preset.terrain));
    double overlaps = 0;
    for (std::size_t i = 0; i + 1 < preset.views.size(); ++i) {
      Preset pair = preset;
      pair.views = {preset.views[i], preset.views[i + 1]};
      int both = 0, all = 0;
      for (const auto& [square, views] : views_of_ground(pair, scene, 0.08)) {
        both += views == 2;
        all += views;
      }
      const double overlap = 2.0 * both / all;
      EXPECT_NEAR(overlap, stated, 0.10) << i << ": boulders, turns";
      overlaps += overlap;
    }
    EXPECT_NEAR(overlaps / static_cast<double>(preset.views.size() - 1), stated, 0.04);
  }
}

// The median of the standard deviations in windows of 9 x 9 pixels [grey levels], in the middle of
// a noise-free image of the presets' own size.
double contrast_of(const Preset& preset) {
  const TriangleMesh mesh = terrain_mesh(preset.terrain);
  const RayScene scene(mesh);
  const Lens whole = make_lens(1024, 768, 80);
  const Lens lens{144, 108, whole.focal, 71.5, 53.5};
  const cv::Mat3f image = render_radiance(scene, seabed_shader(mesh, scene, preset.texture), lens,
                                          &preset.port, preset.views[0], 2);
  std::vector<double> deviations;
  for (int top = 0; top + 9 <= image.rows; top += 9)
    for (int left = 0; left + 9 <= image.cols; left += 9) {
      double sum = 0, squares = 0;
      for (int y = top; y < top + 9; ++y)
        for (int x = left; x < left + 9; ++x) {
          const double grey = 255 * static_cast<double>(image(y, x)[1]);
          sum += grey;
          squares += grey * grey;
        }
      deviations.push_back(std::sqrt(std::max(0.0, squares / 81 - sum * sum / 81 / 81)));
    }
  std::ranges::nth_element(deviations, deviations.begin() + std::ssize(deviations) / 2);
  return deviations[deviations.size() / 2];
}

TEST(Sand, HasATextureOfAboutTheNoisesContrast) {
  constexpr double kNoise = 1.2;  // SimulateUnderwater's default
  const double sand = contrast_of(small("sand", 1024, 768, 3));
  EXPECT_GT(sand, 0.4 * kNoise);
  EXPECT_LT(sand, 1.5 * kNoise);
  EXPECT_GT(contrast_of(small("reef", 1024, 768, 3)), 6 * kNoise);
}

TEST(Sand, HasLowRipples) {
  const Floor floor = small("sand", 64, 48, 1).terrain.floor;
  Floor smooth = floor;
  smooth.ripple_height = 0;
  double least = 0, most = 0;
  for (double x = -1; x < 1; x += 0.01) {
    const double ripple = floor.at(x, 0.3) - smooth.at(x, 0.3);
    least = std::min(least, ripple);
    most = std::max(most, ripple);
  }
  EXPECT_NEAR(most - least, floor.ripple_height, 0.02 * floor.ripple_height);
}

TEST(Hazy, IsAPresetInHazeAndOtherwiseTheSame) {
  for (const char* name : {"reef", "closeup", "sand"}) {
    const Preset clear = small(name, 64, 48, 8),
                 hazy = small(std::string(name) + "-hazy", 64, 48, 8);
    EXPECT_EQ(clear.haze, 0);
    EXPECT_EQ(hazy.haze, 6.0 / 7);
    ASSERT_EQ(clear.views.size(), hazy.views.size());
    for (std::size_t i = 0; i < clear.views.size(); ++i)
      EXPECT_EQ(clear.views[i].centre, hazy.views[i].centre);
    EXPECT_EQ(clear.texture.seed, hazy.texture.seed);
  }
  EXPECT_THROW(small("-hazy", 64, 48, 8), Error);
  EXPECT_THROW(small("lake-hazy", 64, 48, 8), Error);
}

}  // namespace
}  // namespace axial::simulate
