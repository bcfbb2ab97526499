// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/adjacency.h"

#include <algorithm>
#include <tuple>

namespace axial::texture {

std::uint64_t bytes_to_pair(std::uint64_t faces) {
  // An edge of each corner with its face; a pair for every two of these edges.
  return 3 * faces * (3 * sizeof(std::uint32_t) + sizeof(FacePair) / 2);
}

std::vector<FacePair> face_pairs(std::span<const std::array<std::uint32_t, 3>> faces) {
  struct EdgeOfFace {
    std::uint32_t from, to, face;
    bool operator<(const EdgeOfFace& o) const {
      return std::tie(from, to, face) < std::tie(o.from, o.to, o.face);
    }
  };
  std::vector<EdgeOfFace> sides;
  sides.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [from, to] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      if (from != to) sides.push_back({from, to, f});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<FacePair> pairs;
  pairs.reserve(sides.size() / 2);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const EdgeOfFace &s = sides[i - 1], &t = sides[i];
    if (s.from == t.from && s.to == t.to && s.face != t.face)
      pairs.push_back({s.face, t.face, s.from, s.to});
  }
  return pairs;
}

}  // namespace axial::texture
