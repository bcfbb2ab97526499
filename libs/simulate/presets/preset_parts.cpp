// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/presets/preset_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "simulate/noise.h"

namespace axial::simulate {

double RandomSequence::between(double a, double b) {
  return a + (b - a) * uniform(seed_, index_++);
}

std::uint32_t RandomSequence::seed() {
  return static_cast<std::uint32_t>(between(0, 4294967295.0));
}

View look_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target,
             const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = (target - centre).normalized();
  const Eigen::Vector3d x = z.cross(up).normalized();
  View view;
  view.rotation.row(0) = x;
  view.rotation.row(1) = z.cross(x);
  view.rotation.row(2) = z;
  view.centre = centre;
  return view;
}

Eigen::Matrix3d random_turn(double most_tilt, RandomSequence& random) {
  const double tilt = random.between(-most_tilt, most_tilt), turn = random.between(0, 6.28);
  return (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void shake(View& view, double degrees, RandomSequence& random) {
  for (int axis = 0; axis < 3; ++axis) {
    const double angle = random.between(-degrees, degrees) * kRadians;
    view.rotation =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix() * view.rotation;
  }
}

namespace {

Blob boulder(const Floor& floor, double x, double y, double radius, RandomSequence& random) {
  Blob blob;
  blob.radii = {radius * random.between(0.8, 1.25), radius * random.between(0.8, 1.25),
                radius * random.between(0.65, 1.0)};
  blob.turn = random_turn(0.4, random);
  blob.centre = {x, y, floor.at(x, y) + random.between(0.0, 0.35) * blob.radii.z()};
  blob.roughness = random.between(0.2, 0.34);
  blob.seed = random.seed();
  return blob;
}

}  // namespace

void add_mushroom(Terrain& terrain, double x, double y, double size, RandomSequence& random) {
  const double ground = terrain.floor.at(x, y);
  Blob stalk;
  stalk.radii = {0.36 * size, 0.33 * size, 0.9 * size};
  stalk.centre = {x, y, ground + 0.25 * size};
  stalk.roughness = 0.25;
  stalk.seed = random.seed();
  Blob cap;
  cap.radii = {random.between(0.85, 1.05) * size, random.between(0.75, 0.95) * size, 0.38 * size};
  cap.turn = random_turn(0.25, random);
  cap.centre = {x + random.between(-0.15, 0.15) * size, y + random.between(-0.15, 0.15) * size,
                ground + 1.05 * size};
  cap.roughness = 0.24;
  cap.seed = random.seed();
  terrain.blobs.push_back(stalk);
  terrain.blobs.push_back(cap);
}

void add_arch(Terrain& terrain, double x, double y, double span_radius, RandomSequence& random) {
  Arch arch;
  const double turn = random.between(0, 3.14);
  arch.along = {std::cos(turn), std::sin(turn)};
  arch.centre = {x, y, terrain.floor.at(x, y)};
  arch.span_radius = span_radius;
  arch.rise = random.between(0.9, 1.1);
  arch.tube_radius = 0.27 * span_radius;
  arch.seed = random.seed();
  terrain.arches.push_back(arch);
}

void scatter(Terrain& terrain, int count, const Eigen::Vector2d& half, double from,
             const Eigen::Vector2d& radii, RandomSequence& random) {
  while (count > 0) {
    const double x = random.between(-half.x(), half.x()), y = random.between(-half.y(), half.y());
    const double t = random.between(0, 1);
    if (std::hypot(x, y) < from) continue;
    // Many small boulders, few large ones.
    const double radius = radii.x() + (radii.y() - radii.x()) * t * t;
    terrain.blobs.push_back(boulder(terrain.floor, x, y, radius, random));
    --count;
  }
}

void add_two_rows(Preset& preset, int views, double height, RandomSequence& random) {
  const int columns = (views + 1) / 2;
  for (int i = 0; i < views; ++i) {
    const int row = i / columns;
    // Forth along one row, back along the other.
    const int column = row == 0 ? i : 2 * columns - 1 - i;
    const Eigen::Vector3d centre =
        Eigen::Vector3d(0.5 * (column - 0.5 * (columns - 1)), 0.55 * (row - 0.5), height) +
        random.within(Eigen::Vector3d(0.06, 0.06, 0.12));
    View view = look_at(centre, centre - Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
    shake(view, 6, random);
    preset.views.push_back(view);
  }
}

void add_two_rings(Preset& preset, int views, double range, RandomSequence& random) {
  const int lower = (2 * views + 2) / 3;
  for (int i = 0; i < views; ++i) {
    const bool low = i < lower;
    const double step = low ? (i + 0.0) / lower : (i - lower + 0.35) / std::max(1, views - lower);
    const double around = 2 * std::numbers::pi * step + random.between(-0.06, 0.06);
    const double elevation = ((low ? 57 : 77) + random.between(-2, 2)) * kRadians;
    const double away = range + random.between(-0.03, 0.03);
    const Eigen::Vector2d aside = random.within(Eigen::Vector2d(0.03, 0.03));
    const Eigen::Vector3d target(aside.x(), aside.y(), 0.06);
    const Eigen::Vector3d offset(std::cos(elevation) * std::cos(around),
                                 std::cos(elevation) * std::sin(around), std::sin(elevation));
    View view = look_at(target + away * offset, target, Eigen::Vector3d::UnitZ());
    shake(view, 3, random);
    preset.views.push_back(view);
  }
}

}  // namespace axial::simulate
