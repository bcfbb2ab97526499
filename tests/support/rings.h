// SPDX-License-Identifier: GPL-3.0-or-later
// Rings for tests of polygons, and a test of places that shares nothing with the libraries.
#pragma once

#include <cmath>
#include <numbers>

#include "geometry/polygon_pieces.h"

namespace axial::test {

// A star with `corners` outer and as many inner corners.
inline geometry::Ring star(const Eigen::Vector2d& centre, double inner, double outer, int corners) {
  geometry::Ring ring;
  for (int i = 0; i < 2 * corners; ++i) {
    const double angle = 0.1 + std::numbers::pi * i / corners, radius = i % 2 ? inner : outer;
    ring.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

// By the number of sides that a ray to the right crosses.
inline bool is_inside(const geometry::Ring& ring, const Eigen::Vector2d& place) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > place.y()) != (b.y() > place.y()) &&
        place.x() < a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

}  // namespace axial::test
