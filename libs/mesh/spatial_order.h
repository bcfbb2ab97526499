// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace axial::mesh {

// Returns the indices of `points` in the order of a Morton curve through their bounding cube, so
// that neighbours in space are near each other in memory. Points in the same of 2^63 cells stay in
// their order. Precondition: the positions are finite.
std::vector<std::uint32_t> spatial_order(std::span<const Eigen::Vector3f> points);

}  // namespace axial::mesh
