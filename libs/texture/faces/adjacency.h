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

// Returns the pairs of faces with a common edge, sorted by (from, to). If more than two faces share
// an edge, the faces are sorted by index, and each face is paired only with the next one.
// FacePair::a is always less than FacePair::b. If two corners of a face are the same vertex, the
// side between them is no edge and gives no pair.
std::vector<FacePair> face_pairs(std::span<const std::array<std::uint32_t, 3>> faces);

// The memory [bytes] of face_pairs() with its result.
std::uint64_t bytes_to_pair(std::uint64_t faces);

}  // namespace axial::texture
