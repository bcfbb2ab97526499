// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/spatial_order.h"

#include <algorithm>
#include <utility>

namespace axial::mesh {
namespace {

// Moves the lowest 21 bits of x apart, with two zeros between neighbouring bits.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return {};
  Eigen::Vector3f low = points[0], high = points[0];
  for (const Eigen::Vector3f& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector3d origin = low.cast<double>();
  const double side = (high.cast<double>() - origin).maxCoeff();
  const double scale = side > 0 ? 2097151 / side : 0;  // 2^21 - 1 cells
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d cell = (point.cast<double>() - origin) * scale;
    keys.emplace_back(spread(static_cast<std::uint64_t>(cell.x())) |
                          spread(static_cast<std::uint64_t>(cell.y())) << 1 |
                          spread(static_cast<std::uint64_t>(cell.z())) << 2,
                      static_cast<std::uint32_t>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, index] : keys) order.push_back(index);
  return order;
}

}  // namespace axial::mesh
