// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace axial::geometry {

// Sets `part` to the corners of the part of a convex polygon on which `distance`, a linear function
// of the place, is 0 or more; in the polygon's direction. The part has at most one corner more.
// `part` is not the memory of `corners`.
template <class Distance>
void convex_part(std::span<const Eigen::Vector3d> corners, const Distance& distance,
                 std::vector<Eigen::Vector3d>& part) {
  part.clear();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector3d &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double at_a = distance(a), at_b = distance(b);
    if (at_a >= 0) part.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0))
      part.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
}

}  // namespace axial::geometry
