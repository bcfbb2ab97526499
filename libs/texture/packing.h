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

// The largest side of a texture [px] that the options allow. Errors as for pack().
int largest_side(const PackingOptions& options);

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

// The size of a rectangle of the given size at the scale of its place, rounded up to whole pixels.
cv::Size size_at(const Place& place, cv::Size size);

// Places rectangles of the given sizes [px], with sides of at least 1. The first rectangle lies in
// the upper left corner of the first texture.
//
// A texture is a square at first. Its side is at least as long as the longest side of a rectangle,
// and so long that the remaining rectangles fill at most 90 % of its area. The side grows step by
// step until all remaining rectangles fit or until max_size is reached. The rectangles that do not
// fit are placed in a further texture. Where the remaining rectangles could fill more than 16
// textures, only the highest and the lowest of them are tried for the next texture, so that the
// time grows only a little faster than the number of rectangles. At the end, the height is reduced
// to the smallest allowed side that contains the lowest rectangle. Sides are powers of two or
// multiples of `multiple`, except that a side longer than max_size is reduced to max_size. A
// rectangle longer than max_size is scaled down (Place::scale).
//
// Error for a max_size that is neither 0 nor from 16 to 32768, and for a `multiple` that is
// negative or larger than max_size.
Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options);

}  // namespace axial::texture
