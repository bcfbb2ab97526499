// SPDX-License-Identifier: GPL-3.0-or-later
// The black and white pattern of a target in the plane of the target.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>

#include "targets/codes/family.h"

namespace axial::targets {

// Radii of a circular target in units of the radius of the dot. Generators differ.
struct RingRadii {
  double inner = 2, outer = 3;  // of the ring of segments
  double plate = 4;             // half the side of the black plate
};

// The pattern of a target. x grows to the right and y down, for a reader in front of the plate; the
// origin is the centre. The unit is the radius of the dot (ring), or a cell (square).
class Pattern {
 public:
  // The target `number` of `family`, with `radii` if it is a ring. Throws an Error for a number
  // that the family does not have.
  Pattern(const Family& family, std::size_t number, const RingRadii& radii = {});

  // A ring whose segments have the lowest `bits` bits of `code`. Segment k covers the angles from
  // 2 pi k / bits to 2 pi (k + 1) / bits. Angles are 0 along x and grow towards y (clockwise).
  Pattern(std::uint32_t code, int bits, const RingRadii& radii);

  // True if the point is white. Points outside the plate are black (ring) or white (square).
  bool white(double x, double y) const;

  // Half the side of the plate. A square has a white margin of one cell around the black border.
  double half_plate() const { return half_plate_; }

  // Half the side of the marker with its black border (square only).
  double half_marker() const { return static_cast<double>(cells_.rows) / 2; }

 private:
  std::uint32_t code_ = 0;
  int bits_ = 0;
  RingRadii radii_;
  cv::Mat1b cells_;  // square: 0 or 255, with the border; ring: empty
  double half_plate_ = 0;
};

// Returns the share of white (0 to 255) in each pixel of a square picture of the plate, `side`
// pixels wide. The first row is the upper edge of the plate.
cv::Mat1b draw_plate(const Pattern& pattern, int side);

}  // namespace axial::targets
