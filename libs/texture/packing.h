// SPDX-License-Identifier: GPL-3.0-or-later
// Places rectangles in as few textures as possible, without overlap.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace axial::texture {

struct PackingOptions {
  int max_size = 8192;  // of a side of a texture [px]; 0: no limit but that of the packer, 32768
  int multiple = 0;     // sides are multiples of this number; 0: powers of two
};

struct Place {
  std::uint32_t texture = 0;
  cv::Point corner;  // upper left pixel
  double scale = 1;  // below 1 for a rectangle that would be larger than a texture
};

struct Packing {
  std::vector<Place> places;    // one per rectangle
  std::vector<cv::Size> sizes;  // of the textures
  std::size_t scaled_down = 0;  // rectangles with a scale below 1
};

// The size of a rectangle at the scale of its place.
cv::Size size_at(const Place& place, cv::Size size);

// Places rectangles of the given sizes, all sides at least 1. The first rectangle lies in the
// corner of the first texture. The sides of the textures begin at a size for which the rectangles
// fill 90 % of the area, and grow step by step until all rectangles fit or max_size is reached;
// then there are more textures. A texture is cut below its last rectangle. The sides are at most
// max_size, even if that is not a power of two or a multiple. Error for a max_size below 16 and not
// 0, and for a negative `multiple`.
Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options);

}  // namespace axial::texture
