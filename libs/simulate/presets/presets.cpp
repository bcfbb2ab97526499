// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/presets/presets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "base/error.h"
#include "simulate/presets/preset_parts.h"
#include "simulate/presets/survey_change.h"

namespace axial::simulate {
namespace {

// The first ones of the blobs of "reef" are large boulders.
constexpr int kReefBoulders = 30;

void make_reef(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(0), 0.020, 0.014, 1.0, 1.52, 1.333};
  preset.texture = {seed, 1.0};
  RandomSequence random(seed);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 2.2, 0.42, 1, 2, 0};
  terrain.cell = 0.010;
  terrain.half_width = 4.4;
  terrain.half_height = 3.6;
  terrain.skirt = 12;
  scatter(terrain, kReefBoulders, {4.2, 3.4}, 0, {0.14, 0.55}, random);
  scatter(terrain, 40, {3.6, 2.8}, 0, {0.05, 0.14}, random);
  for (const auto& [x, y] : {std::pair{-1.3, 0.5}, {0.4, -0.7}, {1.7, 0.6}, {-0.3, 1.4}}) {
    const double size = random.between(0.36, 0.48);
    const Eigen::Vector2d aside = random.within(Eigen::Vector2d(0.2, 0.2));
    add_mushroom(terrain, x + aside.x(), y + aside.y(), size, random);
  }
  add_arch(terrain, -0.6, -0.8, 0.42, random);
  add_arch(terrain, 1.0, 0.3, 0.38, random);

  add_two_rows(preset, views, 2.90, random);
}

// Forth along one row, back along the next. The seabed grows with the number of rows.
void make_survey(Preset& preset, std::uint32_t seed, int views) {
  constexpr int kColumns = 10;
  constexpr double kStep = 0.9, kHeight = 2.9, kMargin = 2.6;
  const int rows = (views + kColumns - 1) / kColumns;
  preset.port = {tilted_normal(0), 0.020, 0.014, 1.0, 1.52, 1.333};
  preset.texture = {seed + 2000u, 1.0};
  RandomSequence random(seed + 2000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 2.2, 0.42, 1, 2, 0};
  terrain.cell = 0.02;
  terrain.half_width = 0.5 * kStep * (kColumns - 1) + kMargin;
  terrain.half_height = 0.5 * kStep * (rows - 1) + kMargin;
  terrain.skirt = 12;
  scatter(terrain, views, {terrain.half_width, terrain.half_height}, 0, {0.08, 0.4}, random);

  for (int i = 0; i < views; ++i) {
    const int row = i / kColumns, along = i % kColumns;
    const int column = row % 2 == 0 ? along : kColumns - 1 - along;
    const Eigen::Vector3d centre = Eigen::Vector3d(kStep * (column - 0.5 * (kColumns - 1)),
                                                   kStep * (row - 0.5 * (rows - 1)), kHeight) +
                                   random.within(Eigen::Vector3d(0.06, 0.06, 0.12));
    View view = look_at(centre, centre - Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
    shake(view, 4, random);
    preset.views.push_back(view);
  }
}

// Bedded rock that rises from the sediment, with fallen blocks around it, photographed along an
// uneven arc.
void make_outcrop(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(0), 0.020, 0.014, 1.0, 1.52, 1.333};
  preset.texture = {seed + 3000u, 0.8};
  RandomSequence random(seed + 3000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 1.6, 0.30, 0.3, 1.9, -0.7};
  terrain.floor.layer = 0.11;
  terrain.floor.dip = {random.between(-0.3, 0.3), random.between(0.1, 0.3)};
  terrain.cell = 0.008;
  terrain.half_width = 3.2;
  terrain.half_height = 3.2;
  terrain.skirt = 10;
  scatter(terrain, 14, {2.2, 2.2}, 1.0, {0.10, 0.30}, random);
  scatter(terrain, 60, {2.4, 2.4}, 0.3, {0.03, 0.09}, random);

  for (int i = 0; i < views; ++i) {
    const double along = views > 1 ? i / (views - 1.0) : 0.5;
    const double around = (-155 + 130 * along + random.between(-4, 4)) * kRadians;
    const double elevation = random.between(52, 70) * kRadians;
    const double range = random.between(2.2, 2.7);
    const Eigen::Vector2d aside = random.within(Eigen::Vector2d(0.15, 0.15));
    const Eigen::Vector3d target(aside.x(), aside.y(), -0.25);
    const Eigen::Vector3d offset(std::cos(elevation) * std::cos(around),
                                 std::cos(elevation) * std::sin(around), std::sin(elevation));
    View view = look_at(target + range * offset, target, Eigen::Vector3d::UnitZ());
    shake(view, 5, random);
    preset.views.push_back(view);
  }
}

void make_closeup(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(3), 0.030, 0.018, 1.0, 1.49, 1.333};
  preset.texture = {seed + 1000u, 0.30};
  RandomSequence random(seed + 1000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 0.5, 0.07, 0.30, 0.70, 0.27};
  terrain.cell = 0.003;
  terrain.half_width = 1.25;
  terrain.half_height = 1.25;
  terrain.skirt = 4;
  add_mushroom(terrain, -0.03, 0.02, 0.17, random);
  add_mushroom(terrain, 0.17, -0.16, 0.08, random);
  add_arch(terrain, -0.17, -0.14, 0.12, random);
  add_arch(terrain, 0.14, 0.17, 0.09, random);
  scatter(terrain, 8, {0.35, 0.35}, 0.20, {0.04, 0.09}, random);
  scatter(terrain, 50, {1.1, 1.1}, 0.25, {0.015, 0.07}, random);

  add_two_rings(preset, views, 0.81, random);
}

// This haze leaves a seventh of the contrast.
constexpr double kHaze = 6.0 / 7;

void scale_terrain(Terrain& terrain, double scale) {
  for (double* length : {&terrain.floor.wavelength, &terrain.floor.height, &terrain.floor.bowl_from,
                         &terrain.floor.bowl_to, &terrain.floor.bowl_height, &terrain.floor.layer,
                         &terrain.floor.ripple_height, &terrain.floor.ripple_length, &terrain.cell,
                         &terrain.half_width, &terrain.half_height, &terrain.skirt})
    *length *= scale;
  terrain.growth.centre *= scale;
  terrain.growth.half *= scale;
  for (double* length : {&terrain.growth.height, &terrain.growth.edge}) *length *= scale;
  for (Blob& blob : terrain.blobs) {
    blob.centre *= scale;
    blob.radii *= scale;
  }
  for (Arch& arch : terrain.arches) {
    arch.centre *= scale;
    arch.span_radius *= scale;
    arch.tube_radius *= scale;
  }
  for (Tube& tube : terrain.tubes) {
    for (Eigen::Vector3d& point : tube.spine) point *= scale;
    for (double& radius : tube.radii) radius *= scale;
  }
}

void scale_preset(Preset& preset, double scale) {
  scale_terrain(preset.terrain, scale);
  preset.texture.largest *= scale;
  if (preset.moved) preset.moved->from *= scale;
  for (View& view : preset.views) view.centre *= scale;
}

void check_factor(const char* name, double value) {
  if (!(value >= 0.01 && value <= 100)) fail("{} is {}: must be between 0.01 and 100", name, value);
}

constexpr int kMostViews = 100000;

}  // namespace

Port port_of_view(const Preset& preset, const View& view) {
  if (view.camera == 1) return preset.second_port.value();
  if (!preset.water_level) return preset.port;
  return surface_port(*preset.water_level, view, preset.port.n_air, preset.port.n_water);
}

void check_ports(const Preset& preset) {
  if (!preset.water_level) return check_port(preset.port, preset.lens);
  for (std::size_t i = 0; i < preset.views.size(); ++i) {
    try {
      check_port(port_of_view(preset, preset.views[i]), preset.lens);
    } catch (const Error& error) {
      fail("view {}: {}", i, error.text());
    }
  }
}

void check_submerged(const Preset& preset, const TriangleMesh& mesh) {
  if (!preset.water_level) return;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (!(vertex.z() < *preset.water_level))
      fail("the water surface is at a height of {} m, but the scene reaches {} m",
           *preset.water_level, vertex.z());
}

Preset make_preset(const PresetOptions& options) {
  if (options.views < 0 || options.views > kMostViews)
    fail("number of views is {}: must be between 0 (the preset's own) and {}", options.views,
         kMostViews);
  check_factor("scale", options.scale);
  check_factor("relief", options.relief);
  check_factor("coarseness", options.coarseness);
  if (!(options.overlap >= 0 && options.overlap <= 0.95))
    fail("overlap is {}: must be between 0 and 0.95", options.overlap);
  Preset preset;
  preset.overlap = options.overlap;
  preset.lens = make_lens(options.width, options.height, options.horizontal_fov_degrees);
  std::string name = options.name;
  if (constexpr std::string_view kHazy = "-hazy"; name.ends_with(kHazy)) {
    name.resize(name.size() - kHazy.size());
    preset.haze = kHaze;
  }
  struct Named {
    const char* name;
    void (*make)(Preset& preset, std::uint32_t seed, int views);
    int views;
  };
  constexpr Named kAll[] = {{"reef", make_reef, 10},         {"outcrop", make_outcrop, 10},
                            {"closeup", make_closeup, 12},   {"survey", make_survey, 50},
                            {"thicket", make_thicket, 12},   {"sand", make_sand, 10},
                            {"transect", make_transect, 12}, {"amphora", make_amphora, 12}};
  const auto found = std::ranges::find(kAll, name, [](const Named& one) { return one.name; });
  if (found == std::end(kAll))
    fail(
        "preset '{}' is unknown: must be reef, outcrop, closeup, survey, thicket, sand, "
        "transect or amphora, or one of them with haze: NAME-hazy",
        options.name);
  found->make(preset, options.seed, options.views > 0 ? options.views : found->views);
  if (options.overlap != PresetOptions{}.overlap && found->make != make_transect)
    fail("preset '{}' has an overlap of its own: only that of transect can be set", options.name);
  if (options.changed) {
    if (found->make != make_reef)
      fail("preset '{}' has no second survey after a change: only reef has one", options.name);
    change_survey(preset, kReefBoulders, options.seed);
  }
  preset.terrain.relief = options.relief;
  preset.terrain.cell *= options.coarseness;
  scale_preset(preset, options.scale);
  return preset;
}

}  // namespace axial::simulate
