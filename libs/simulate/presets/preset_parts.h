// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/simulate: parts from which presets are built.
#pragma once

#include <cstdint>

#include "simulate/optics.h"
#include "simulate/presets/preset.h"

namespace axial::simulate {

// A sequence of uniform random numbers, the same for the same seed. Every call takes the next
// number of the sequence.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : seed_(seed) {}
  double between(double a, double b);  // a number in [a, b)
  // A vector whose coordinates are in [-half, half). The last coordinate is drawn first.
  template <int kRows>
  Eigen::Matrix<double, kRows, 1> within(const Eigen::Matrix<double, kRows, 1>& half) {
    Eigen::Matrix<double, kRows, 1> vector;
    for (int k = kRows - 1; k >= 0; --k) vector[k] = between(-half[k], half[k]);
    return vector;
  }
  std::uint32_t seed();  // an integer from the whole range, for use as a seed

 private:
  std::uint64_t seed_, index_ = 0;
};

// A camera at `centre` that looks at `target`. The direction `up` points upwards in the image as
// far as possible. All arguments are in the world frame. Precondition: the camera does not look
// along `up`.
View look_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target,
             const Eigen::Vector3d& up);

// The rotation by an angle of up to `most_tilt` [rad] about x, and then by any angle about z.
Eigen::Matrix3d random_turn(double most_tilt, RandomSequence& random);

// Rotates the camera about each of its axes by a random angle of up to `degrees`.
void shake(View& view, double degrees, RandomSequence& random);

// Adds a stalk with a cap that overhangs it on all sides, on the floor at (x, y) [m]. `size` [m]:
// about the radius of the cap, and the height of the cap's middle.
void add_mushroom(Terrain& terrain, double x, double y, double size, RandomSequence& random);

// Adds an arch (blob.h) on the floor at (x, y) [m], in a random direction. `span_radius` [m]: about
// its height and half of its width.
void add_arch(Terrain& terrain, double x, double y, double span_radius, RandomSequence& random);

// Scatters `count` boulders over the rectangle |x| <= half.x, |y| <= half.y. The centre of a
// boulder is at least `from` [m] from the origin, measured horizontally. A radius [m] is between
// radii.x and radii.y, mostly near radii.x. Random factors then change the three axes of each
// boulder. Precondition: `from` is less than the length of `half`; otherwise the function does not
// end.
void scatter(Terrain& terrain, int count, const Eigen::Vector2d& half, double from,
             const Eigen::Vector2d& radii, RandomSequence& random);

// Adds `views` views that look down from about the height `height` [m] in the world. The views form
// two rows: the camera moves along one row, and back along the other.
void add_two_rows(Preset& preset, int views, double height, RandomSequence& random);

// Adds `views` views around the origin from a distance of about `range` [m]: two thirds in a lower
// ring, the others in a narrower ring above it.
void add_two_rings(Preset& preset, int views, double range, RandomSequence& random);

// Fill `preset` with the presets "thicket", "sand", "transect" and "amphora" (presets.h), with
// `views` views. Precondition: preset.lens is set.
void make_thicket(Preset& preset, std::uint32_t seed, int views);
void make_sand(Preset& preset, std::uint32_t seed, int views);
void make_transect(Preset& preset, std::uint32_t seed, int views);
void make_amphora(Preset& preset, std::uint32_t seed, int views);

}  // namespace axial::simulate
