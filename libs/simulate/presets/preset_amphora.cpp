// SPDX-License-Identifier: GPL-3.0-or-later
// The preset "amphora": a vessel with a neck and two handles that leans amid broken ground.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "simulate/presets/preset_parts.h"

namespace axial::simulate {
namespace {

// The vessel in its own frame: z along its axis, from the foot; x towards a handle. The unit is the
// largest radius of the body.
struct Vessel {
  Eigen::Vector3d foot;  // world [m]
  Eigen::Matrix3d turn;  // from the vessel's axes to the world
  double size;           // [m]

  Eigen::Vector3d at(double x, double y, double z) const {
    return foot + size * (turn * Eigen::Vector3d(x, y, z));
  }
};

constexpr double kBody = 2.6, kMouth = 3.5;  // heights of the shoulder's end and of the mouth
constexpr double kNeck = 0.3;                // radius

// A tube along points in the vessel's frame, with one radius.
Tube tube_through(const Vessel& vessel, const std::vector<Eigen::Vector3d>& points, double radius) {
  Tube tube;
  for (const Eigen::Vector3d& p : points) {
    tube.spine.push_back(vessel.at(p.x(), p.y(), p.z()));
    tube.radii.push_back(vessel.size * radius);
  }
  return tube;
}

// The ring around the mouth. Its ends overlap.
Tube rim_of(const Vessel& vessel) {
  constexpr int kPoints = 48;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double around = 2 * std::numbers::pi * i / kPoints;
    points.emplace_back(1.15 * kNeck * std::cos(around), 1.15 * kNeck * std::sin(around), kMouth);
  }
  return tube_through(vessel, points, 0.09);
}

// A handle from the neck to the shoulder, on the side `sign` of the axis.
Tube handle_of(const Vessel& vessel, double sign) {
  constexpr int kPoints = 24;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = static_cast<double>(i) / kPoints;  // from the neck to the shoulder
    const double out = kNeck + 0.52 * std::sin(std::numbers::pi * t) + 0.45 * t;
    points.emplace_back(sign * out, 0, kMouth - 0.25 - 1.35 * t);
  }
  return tube_through(vessel, points, 0.11);
}

void add_vessel(Terrain& terrain, const Vessel& vessel, RandomSequence& random) {
  Blob body;
  body.centre = vessel.at(0, 0, 0.5 * kBody);
  body.radii = vessel.size * Eigen::Vector3d(1, 1, 0.55 * kBody);
  body.turn = vessel.turn;
  body.roughness = 0.05;
  body.seed = random.seed();
  terrain.blobs.push_back(body);
  terrain.tubes.push_back(
      tube_through(vessel, {{0, 0, 0.9 * kBody}, {0, 0, 1.1 * kBody}, {0, 0, kMouth}}, kNeck));
  terrain.tubes.push_back(rim_of(vessel));
  for (const double sign : {-1.0, 1.0}) terrain.tubes.push_back(handle_of(vessel, sign));
}

// Blocks on the ground close around the vessel, some of which lean over gaps.
void add_blocks(Terrain& terrain, RandomSequence& random) {
  constexpr int kBlocks = 9;
  for (int i = 0; i < kBlocks; ++i) {
    const double around = 2 * std::numbers::pi * (i + random.between(-0.3, 0.3)) / kBlocks;
    const double distance = random.between(0.20, 0.36);
    Blob block;
    const double x = distance * std::cos(around), y = distance * std::sin(around);
    block.radii = {random.between(0.05, 0.10), random.between(0.04, 0.07),
                   random.between(0.03, 0.05)};
    block.centre = {x, y, terrain.floor.at(x, y) + random.between(0.02, 0.07)};
    block.turn = random_turn(0.7, random);
    block.roughness = 0.25;
    block.seed = random.seed();
    terrain.blobs.push_back(block);
  }
}

}  // namespace

void make_amphora(Preset& preset, std::uint32_t seed, int views) {
  preset.port = {tilted_normal(3), 0.030, 0.018, 1.0, 1.49, 1.333};
  preset.texture = {seed + 5000u, 0.30};
  RandomSequence random(seed + 5000u);
  Terrain& terrain = preset.terrain;
  terrain.floor = {random.seed(), 0.5, 0.10, 0.35, 0.75, 0.25};
  terrain.cell = 0.003;
  terrain.half_width = 1.25;
  terrain.half_height = 1.25;
  terrain.skirt = 4;
  Vessel vessel;
  vessel.size = 0.085;
  vessel.foot = {-0.09, random.between(-0.03, 0.03), 0};
  vessel.foot.z() = terrain.floor.at(vessel.foot.x(), vessel.foot.y()) + 0.02;
  const double roll = random.between(0.5, 1.0), lean = random.between(0.6, 0.9);
  vessel.turn = Eigen::AngleAxisd(random.between(-0.4, 0.4), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ());
  add_vessel(terrain, vessel, random);
  add_blocks(terrain, random);
  add_arch(terrain, -0.22, 0.18, 0.10, random);
  scatter(terrain, 60, {1.1, 1.1}, 0.22, {0.015, 0.07}, random);
  add_two_rings(preset, views, 0.81, random);
}

}  // namespace axial::simulate
