// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/simulate: parts from which presets are built.
#pragma once

#include <cstdint>

#include "simulate/optics.h"
#include "simulate/presets.h"

namespace axial::simulate {

// A sequence of uniform random numbers, the same for the same seed.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : seed_(seed) {}
  double between(double a, double b);
  std::uint32_t seed();

 private:
  std::uint64_t seed_, index_ = 0;
};

// A camera at `centre` that looks at `target`. `up` [world] points upwards in the image as far as
// possible.
View look_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target,
             const Eigen::Vector3d& up);

// Rotates the camera by up to `degrees` about each of its axes.
void shake(View& view, double degrees, RandomSequence& random);

// Adds a stalk with a cap that overhangs it on all sides.
void add_mushroom(Terrain& terrain, double x, double y, double size, RandomSequence& random);

void add_arch(Terrain& terrain, double x, double y, double span_radius, RandomSequence& random);

// Scatters `count` boulders over the rectangle |x| <= half.x, |y| <= half.y. No boulder is
// centred nearer than `from` to the origin, measured horizontally. Radii are between radii.x and
// radii.y, up to random factors of the axes, and most radii are small.
void scatter(Terrain& terrain, int count, const Eigen::Vector2d& half, double from,
             const Eigen::Vector2d& radii, RandomSequence& random);

// Adds views from above in two rows, along one row and back along the other, at a height of about
// `height` [m].
void add_two_rows(Preset& preset, int views, double height, RandomSequence& random);

// Adds views around the origin from a distance of about `range` [m]: two thirds in a lower ring,
// the others in a narrower ring above it.
void add_two_rings(Preset& preset, int views, double range, RandomSequence& random);

// Make the presets of these names (see presets.h). `preset` must have its lens.
void make_thicket(Preset& preset, std::uint32_t seed, int views);
void make_sand(Preset& preset, std::uint32_t seed, int views);
void make_transect(Preset& preset, std::uint32_t seed, int views);

}  // namespace axial::simulate
