// SPDX-License-Identifier: GPL-3.0-or-later
// The preset "thicket": thin and thick structures that grow or hang above a seabed.
#include <Eigen/Geometry>
#include <cmath>

#include "simulate/presets/preset_parts.h"

namespace axial::simulate {
namespace {

// Width of a pixel under water at 0.9 m [m], for views 1024 pixels and 80 degrees wide.
constexpr double kPixel = 0.0011;
// Thickness of the structures [px].
constexpr double kThickness[] = {1, 2, 4, 8, 16};

Eigen::Vector3d any_direction(double least_z, RandomSequence& random) {
  const double around = random.between(0, 6.28), z = random.between(least_z, 1);
  const double level = std::sqrt(std::max(0.0, 1 - z * z));
  return {level * std::cos(around), level * std::sin(around), z};
}

// Adds a branch, and at its end two branches of half its thickness, recursively down to about a
// pixel.
void grow(Terrain& terrain, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
          double length, double radius, RandomSequence& random) {
  constexpr int kPoints = 8;
  Tube branch;
  Eigen::Vector3d at = from, towards = direction;
  for (int i = 0; i < kPoints; ++i) {
    branch.spine.push_back(at);
    branch.radii.push_back(radius);
    towards = (towards + 0.22 * any_direction(-1, random)).normalized();
    at += length / (kPoints - 1) * towards;
  }
  const Eigen::Vector3d tip = branch.spine.back();
  terrain.tubes.push_back(std::move(branch));
  if (radius < 0.99 * kPixel) return;
  const Eigen::Vector3d aside = towards.cross(any_direction(-1, random)).normalized();
  for (const double sign : {-1.0, 1.0}) {
    Eigen::Vector3d next = (towards + sign * random.between(0.5, 0.9) * aside).normalized();
    next = (next + Eigen::Vector3d(0, 0, 0.25)).normalized();  // towards the light
    grow(terrain, tip, next, random.between(0.72, 0.9) * length, 0.5 * radius, random);
  }
}

void add_coral(Terrain& terrain, double x, double y, double thickness, RandomSequence& random) {
  const Eigen::Vector3d root(x, y, terrain.floor.at(x, y) - 0.02);
  const double length = random.between(0.075, 0.10);
  grow(terrain, root, any_direction(0.9, random), length, 0.5 * thickness, random);
}

// Adds a rope that sags between two supports, which are outside the views.
void add_rope(Terrain& terrain, double thickness, RandomSequence& random) {
  const double turn = random.between(0, 3.14), aside = random.between(-0.28, 0.28);
  const double height = random.between(0.08, 0.26), sag = random.between(0.03, 0.10);
  const Eigen::Vector3d along(std::cos(turn), std::sin(turn), 0);
  const Eigen::Vector3d middle(-aside * along.y(), aside * along.x(), height);
  constexpr int kPoints = 81;
  constexpr double kHalf = 0.7;
  Tube rope;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * i / (kPoints - 1) - 1;
    rope.spine.emplace_back(middle + kHalf * t * along +
                            Eigen::Vector3d(0, 0, sag * (t * t - 0.3)));
    rope.radii.push_back(0.5 * thickness);
  }
  terrain.tubes.push_back(std::move(rope));
}

// Adds plates on one stalk, one above the other, that overhang the ground.
void add_plates(Terrain& terrain, double x, double y, double size, RandomSequence& random) {
  const double ground = terrain.floor.at(x, y);
  const auto add = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double tilt) {
    Blob blob;
    blob.centre = centre;
    blob.radii = radii;
    blob.turn = Eigen::AngleAxisd(random.between(0, 6.28), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
    blob.roughness = 0.12;
    blob.seed = random.seed();
    terrain.blobs.push_back(blob);
  };
  add({x, y, ground + 0.5 * size}, {0.14 * size, 0.14 * size, 0.8 * size}, 0);
  for (const double level : {0.5, 0.95, 1.3}) {
    const double tilt = random.between(-0.2, 0.2), narrow = random.between(0.7, 0.9);
    const double east = random.between(-0.3, 0.3), north = random.between(-0.3, 0.3);
    add({x + east * size, y + north * size, ground + level * size},
        {(1.2 - 0.5 * level) * size, narrow * (1.2 - 0.5 * level) * size, 0.06 * size}, tilt);
  }
}

}  // namespace

void make_thicket(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(3), 0.030, 0.018, 1.0, 1.49, 1.333};
  preset.texture = {seed + 4000u, 0.30};
  RandomSequence random(seed + 4000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 0.6, 0.05, 0.45, 0.90, 0.2};
  terrain.cell = 0.003;
  terrain.half_width = 1.35;
  terrain.half_height = 1.35;
  terrain.skirt = 4;
  for (const auto& [x, y] : {std::pair{-0.22, -0.16}, {0.20, 0.18}, {0.02, -0.27}, {-0.05, 0.26}}) {
    const Eigen::Vector2d aside = random.within(Eigen::Vector2d(0.04, 0.04));
    add_coral(terrain, x + aside.x(), y + aside.y(), 16 * kPixel, random);
  }
  for (const double thickness : {8 * kPixel, 8 * kPixel, 4 * kPixel, 4 * kPixel}) {
    const Eigen::Vector2d place = random.within(Eigen::Vector2d(0.35, 0.35));
    add_coral(terrain, place.x(), place.y(), thickness, random);
  }
  for (const double thickness : kThickness)
    for (int i = 0; i < 2; ++i) add_rope(terrain, thickness * kPixel, random);
  add_plates(terrain, 0.03, 0.0, 0.12, random);
  add_plates(terrain, -0.30, 0.14, 0.08, random);
  add_mushroom(terrain, 0.30, -0.12, 0.09, random);
  scatter(terrain, 30, {1.1, 1.1}, 0.2, {0.015, 0.06}, random);
  add_two_rings(preset, views, 0.95, random);
}

}  // namespace axial::simulate
