// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace axial::mesh {

// Returns the indices of `points` in the order of a Morton curve through the bounding cube of the
// points. So most points that are near in space are near in the order. The cube is divided into
// 2^63 cells. Points in the same cell keep their order in `points`. Precondition: the positions are
// finite.
std::vector<std::uint32_t> spatial_order(std::span<const Eigen::Vector3f> points);

}  // namespace axial::mesh
