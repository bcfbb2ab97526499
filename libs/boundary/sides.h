// SPDX-License-Identifier: GPL-3.0-or-later
// The sides of the polygons of a boundary, which are found by place.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "boundary/boundary.h"

namespace axial::boundary {

// Places that are closer than this [m] are one place, and lie on a line that is as close.
inline constexpr double kSame = 1e-6;

// A side of a polygon. Each corner is the begin of one side.
struct Side {
  Eigen::Vector2d from, to;
};

class Sides {
 public:
  explicit Sides(const Boundary& boundary);

  const Side& operator[](std::uint32_t side) const { return sides_[side]; }
  std::size_t size() const { return sides_.size(); }

  // The sides whose boxes touch `box`, up to kSame, in increasing order.
  std::vector<std::uint32_t> near(const Eigen::AlignedBox2d& box) const;
  // Whether there is such a side.
  bool any_near(const Eigen::AlignedBox2d& box) const;

 private:
  // Calls use(side) for sides that may touch the box, some more than once, until it returns true.
  template <class Use>
  bool visit(const Eigen::AlignedBox2d& box, const Use& use) const;
  std::size_t bin_at(double x) const;

  std::vector<Side> sides_;
  Eigen::AlignedBox2d extent_;
  std::vector<std::vector<std::uint32_t>> bins_;  // by x
};

}  // namespace axial::boundary
