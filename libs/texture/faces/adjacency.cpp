// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/adjacency.h"

#include "geometry/edges.h"

namespace axial::texture {

std::uint64_t bytes_to_pair(std::uint64_t faces) {
  // The sides of all faces; a pair for every two of these sides.
  return 3 * faces * (sizeof(geometry::Side) + sizeof(FacePair) / 2);
}

std::vector<FacePair> face_pairs(std::span<const std::array<std::uint32_t, 3>> faces) {
  const std::vector<geometry::Side> sides = geometry::sides_of(faces);
  std::vector<FacePair> pairs;
  pairs.reserve(sides.size() / 2);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const geometry::Side &s = sides[i - 1], &t = sides[i];
    if (s.low == t.low && s.high == t.high && s.low != s.high && s.face != t.face)
      pairs.push_back({s.face, t.face, s.low, s.high});
  }
  return pairs;
}

}  // namespace axial::texture
