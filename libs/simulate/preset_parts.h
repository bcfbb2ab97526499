// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/simulate: what presets are made of.
#pragma once

#include <cstdint>
#include <numbers>

#include "simulate/presets.h"

namespace axial::simulate {

inline constexpr double kRadians = std::numbers::pi / 180;

// Numbers drawn one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double between(double a, double b);
  std::uint32_t seed();

 private:
  std::uint64_t seed_, index_ = 0;
};

// Camera at `centre` that looks at `target`, image up as near world up (or +y) as can be.
View look_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target,
             const Eigen::Vector3d& up);

// Turns the camera by up to `degrees` about each of its axes.
void shake(View& view, double degrees, Draw& draw);

// A stalk and a cap that overhangs it all around.
void add_mushroom(Terrain& terrain, double x, double y, double size, Draw& draw);

void add_arch(Terrain& terrain, double x, double y, double span_radius, Draw& draw);

// Boulders spread over a rectangle, none nearer to the origin than `from`, `radii` from .. to.
void scatter(Terrain& terrain, int count, const Eigen::Vector2d& half, double from,
             const Eigen::Vector2d& radii, Draw& draw);

// Views from two rows, there along one and back along the other, `height` over the origin's level.
void add_two_rows(Preset& preset, int views, double height, Draw& draw);

// Views all around the origin, two thirds in a ring and the others in a narrower one above it.
void add_two_rings(Preset& preset, int views, double range, Draw& draw);

// The presets of these names; `preset` has its lens. presets.h describes them.
void make_thicket(Preset& preset, std::uint32_t seed, int views);
void make_sand(Preset& preset, std::uint32_t seed, int views);
void make_transect(Preset& preset, std::uint32_t seed, int views);

}  // namespace axial::simulate
