// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/joined_vertices.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace axial::geometry {

void join_vertices(Mesh& mesh) {
  const auto key = [&](std::uint32_t v) {
    const Eigen::Vector3f& x = mesh.vertices[v];
    return std::tuple(x.x(), x.y(), x.z(), v);
  };
  std::vector<std::uint32_t> order(mesh.vertices.size()), first(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_again = i > 0 && mesh.vertices[order[i]] == mesh.vertices[order[i - 1]];
    first[order[i]] = is_again ? first[order[i - 1]] : order[i];
  }
  for (auto& face : mesh.faces)
    for (std::uint32_t& corner : face) corner = first[corner];
}

}  // namespace axial::geometry
