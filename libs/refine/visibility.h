// SPDX-License-Identifier: GPL-3.0-or-later
// Which views see which vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "refine/raster.h"

namespace axial::refine {

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

// A vertex is hidden if it lies farther behind the drawn surface, at all four pixels around it,
// than this part of its depth.
inline constexpr float kBehind = 0.003f;

// The surface at a vertex must face the camera: least cosine between its normal and the direction
// to the camera.
inline constexpr float kLeastCosine = 0.1f;

// Marks the vertices that the view sees: inside the image, facing the camera, not hidden.
void mark_seen(std::span<const VertexImage> images, const Shape& shape, const Raster& raster,
               std::size_t view, Visibility& visibility);

}  // namespace axial::refine
