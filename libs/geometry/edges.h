// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a mesh, with the faces at each edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace axial::geometry {

// The side of a face that begins at one of its corners. It lies on the edge of the vertices
// low <= high.
struct Side {
  std::uint32_t low, high, face, corner;

  // clang-tidy takes a literal of the comparison that the compiler makes for a null pointer.
  auto operator<=>(const Side&) const = default;  // NOLINT(modernize-use-nullptr)
};

// The sides of all faces, sorted by edge, face and corner.
std::vector<Side> sides_of(std::span<const std::array<std::uint32_t, 3>> faces);

// Calls visit(sides of one edge) for every edge. `sides`: the result of sides_of().
template <class Visit>
void for_each_edge(std::span<const Side> sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high)
      ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

}  // namespace axial::geometry
