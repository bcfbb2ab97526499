// SPDX-License-Identifier: GPL-3.0-or-later
// Which views see which vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "refine/raster.h"

namespace axial::refine {

// For every vertex and every view, whether the view sees the vertex. At first, no view sees any.
class Visibility {
 public:
  Visibility(std::size_t vertices, std::size_t views)
      : words_((views + 63) / 64), bits_(vertices * words_) {}

  bool seen(std::size_t vertex, std::size_t view) const {
    return bits_[vertex * words_ + view / 64] >> (view % 64) & 1;
  }
  void set_seen(std::size_t vertex, std::size_t view) {
    bits_[vertex * words_ + view / 64] |= std::uint64_t{1} << (view % 64);
  }

 private:
  std::size_t words_;  // of 64 views
  std::vector<std::uint64_t> bits_;
};

// Let d be the depth of a vertex, and s the largest depth of the drawn surface at the four pixels
// around the vertex. The vertex is hidden if d > (1 + kBehind) s.
inline constexpr float kBehind = 0.003f;

// The surface at a vertex faces the camera if the cosine of the angle between the vertex's normal
// (Shape::normals) and the direction to the camera, against the ray, is larger than this value.
inline constexpr float kLeastCosine = 0.1f;

// Marks in `visibility` the vertices that the view with the index `view` sees. The image of such a
// vertex is inside the view, the surface at the vertex faces the camera (kLeastCosine), and the
// vertex is not hidden (kBehind). `images`: of all vertices in the view. `raster`: the mesh drawn
// into the view. A view of less than 2 x 2 pixels sees none.
void mark_seen(std::span<const VertexImage> images, const Shape& shape, const Raster& raster,
               std::size_t view, Visibility& visibility);

}  // namespace axial::refine
