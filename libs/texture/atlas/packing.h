// SPDX-License-Identifier: GPL-3.0-or-later
// Places rectangles in as few textures as possible, without overlap.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/texture.h"

namespace axial::texture {

// The largest side of a texture [px] that the options allow. Errors as for pack().
int largest_side(const PackingOptions& options);

// The place of one rectangle.
struct Place {
  std::uint32_t texture = 0;  // index into Packing::sizes
  cv::Point corner;           // of the rectangle: its upper left pixel in the texture
  // Factor of the rectangle's sides. It is below 1 if a side would be larger than a texture may be.
  double scale = 1;
};

struct Packing {
  std::vector<Place> places;    // one per rectangle, in the order of the rectangles
  std::vector<cv::Size> sizes;  // of the textures [px]
  std::size_t scaled_down = 0;  // rectangles with a scale below 1
};

// The size [px] that a rectangle of the size `size` has at its place: `size` times `place.scale`,
// rounded up to whole pixels.
cv::Size size_at(const Place& place, cv::Size size);

// Places rectangles of the given sizes [px], whose sides must be at least 1. The first rectangle
// lies in the upper left corner of the first texture. Without rectangles there is no texture.
//
// A texture is a square at first. Its side is at least as long as the longest side of a rectangle.
// If max_size allows it, the side is so long that the remaining rectangles fill at most 90 % of the
// area. The side grows step by step until all remaining rectangles fit or until max_size is
// reached. The rectangles that do not fit are placed in a further texture. Where the remaining
// rectangles could fill more than 16 textures, only the highest and the lowest of them are tried
// for the next texture, so that the time grows only a little faster than the number of rectangles.
// At the end, the height is reduced to the smallest allowed side that contains the lowest
// rectangle. Sides are powers of two or multiples of `multiple`, except that a side longer than
// max_size is reduced to max_size. A rectangle longer than max_size is scaled down (Place::scale).
//
// Throws an Error for a max_size that is neither 0 nor from 16 to 32768, and for a `multiple` that
// is negative or larger than max_size. The message calls the two values max_texture_size and
// texture_size_multiple.
Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options);

}  // namespace axial::texture
