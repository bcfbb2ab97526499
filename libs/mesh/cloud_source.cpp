// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cloud_source.h"

namespace axial::mesh {

std::vector<Eigen::Vector3f> some_positions(const CloudSource& cloud, std::size_t most) {
  std::vector<Eigen::Vector3f> positions;
  std::size_t begin = 0, next = 0;  // of the portion; the point to take
  cloud([&](const PointCloud& portion, std::size_t all_points) {
    const std::size_t step = (all_points + most - 1) / most, end = begin + portion.size();
    for (; next < end; next += step) positions.push_back(portion.positions[next - begin]);
    begin = end;
  });
  return positions;
}

}  // namespace axial::mesh
