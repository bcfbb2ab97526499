// SPDX-License-Identifier: GPL-3.0-or-later
// The presets "sand" and "transect": simple ground seen from above.
#include <cmath>

#include "simulate/presets/preset_parts.h"

namespace axial::simulate {
namespace {

constexpr double kCameraHeight = 2.90;  // as in "reef"

// The length of ground, along the image's height, that a view at `height` sees through the port.
double length_seen(const Preset& preset, double height) {
  const double in_air = std::atan(0.5 * preset.lens.height / preset.lens.focal);
  const double in_water = std::asin(std::sin(in_air) * preset.port.n_air / preset.port.n_water);
  return 2 * height * std::tan(in_water);
}

}  // namespace

void make_sand(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(0), 0.020, 0.014, 1.0, 1.52, 1.333};
  preset.texture = {seed + 5000u, 1.0, 0.047};
  RandomSequence random(seed + 5000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 2.2, 0.03, 1, 2, 0};
  terrain.floor.ripple_height = 0.004;
  terrain.floor.ripple_length = 0.2;
  terrain.cell = 0.012;
  terrain.half_width = 4.4;
  terrain.half_height = 3.6;
  terrain.skirt = 12;
  add_two_rows(preset, views, kCameraHeight, random);
}

void make_transect(Preset& preset, std::uint32_t seed, int views) {
  constexpr double kMargin = 0.5;
  preset.port = {tilted_normal(0), 0.020, 0.014, 1.0, 1.52, 1.333};
  preset.texture = {seed + 6000u, 1.0};
  RandomSequence random(seed + 6000u);
  const double step = (1 - preset.overlap) * length_seen(preset, kCameraHeight);
  // Fields of view are wider in air, and images in air are rendered too.
  const double pixel_in_air = kCameraHeight / preset.lens.focal;
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 2.2, 0.22, 1, 2, 0};
  terrain.cell = 0.012;
  terrain.half_width = 0.5 * preset.lens.width * pixel_in_air + kMargin;
  terrain.half_height = 0.5 * (preset.lens.height * pixel_in_air + step * (views - 1)) + kMargin;
  terrain.skirt = 8;
  scatter(terrain, 4 * views, {terrain.half_width, terrain.half_height}, 0, {0.05, 0.22}, random);
  for (int i = 0; i < views; ++i) {
    const Eigen::Vector3d centre =
        Eigen::Vector3d(0, step * (i - 0.5 * (views - 1)), kCameraHeight) +
        random.within(Eigen::Vector3d(0.03, 0.03, 0.04));
    View view = look_at(centre, centre - Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
    shake(view, 1, random);
    preset.views.push_back(view);
  }
}

}  // namespace axial::simulate
