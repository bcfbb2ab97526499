// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace axial::texture {

// Two faces with a common edge.
struct FacePair {
  std::uint32_t a = 0, b = 0;      // faces
  std::uint32_t from = 0, to = 0;  // the vertices of the edge, from < to
};

// All pairs of faces with a common edge, in the order of the edges' vertices. If more than two
// faces share an edge, each is paired with the next, in the order of their indices. Faces with a
// repeated corner have no pair at the edge between equal vertices.
std::vector<FacePair> face_pairs(std::span<const std::array<std::uint32_t, 3>> faces);

}  // namespace axial::texture
