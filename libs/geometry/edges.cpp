// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/edges.h"

#include <algorithm>

namespace axial::geometry {

std::vector<Side> sides_of(std::span<const std::array<std::uint32_t, 3>> faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      sides.push_back({low, high, f, k});
    }
  std::ranges::sort(sides);
  return sides;
}

}  // namespace axial::geometry
