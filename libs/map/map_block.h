// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of a block of a map: heights, colours of the mesh's textures, numbers of views,
// expected errors of heights, relief shading.
//
// The colours are those of the textures, each of which shows a place as one photograph shows it:
// TextureMesh has chosen one photograph for each face and has levelled the seams between the
// photographs. No pixel is a mean of several photographs, so edges are not doubled. Parts of the
// mesh below other parts are not visible in the map, and a place that no photograph shows has no
// colour.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

#include "axial/map.h"
#include "map/frame.h"
#include "map/surface_block.h"

namespace axial::map {

// Throws an Error unless uv and texture_of have one entry for each face if there are textures, each
// texture_of names a texture with pixels, all texture coordinates are finite, and `views` and
// `errors` are empty or have one entry for each face.
void check_content(const MapContent& content);

// The number of samples along each side of a pixel: odd, 1 to 9, and at least 1.5 times the width
// of a pixel in texels. The width in texels is that of the face in the middle (median) of all faces
// with known colours. 1 without such faces.
int samples_per_pixel(const MapContent& content);

// The memory [bytes] of samples_per_pixel().
std::uint64_t bytes_of_samples(const MapContent& content);

struct MapBlock {
  cv::Rect pixels;
  bool is_empty = true;  // no pixel has a height or a colour
  cv::Mat1f heights;     // at the centre of the pixel [map, m]; kNoHeight: no surface
  cv::Mat4b colors;      // R G B alpha; alpha is 0 or 255. Empty if the mesh has no textures
  cv::Mat1w counts;      // views of the face at the centre; kNoCount: no surface. Or empty
  cv::Mat1f errors;      // of the face at the centre [m]; kNoHeight: unknown. Or empty
  cv::Mat1b shades;      // relief shading; 0: no surface
};

// Makes block `block` of `bins`.
//
// Colour: the mean of the samples whose colour is known. A sample has the colour that the texture
// of its face has there, interpolated bilinearly. No colour is known where the mesh has no surface,
// and on a face whose three corners have the same texture coordinates: TextureMesh writes such
// faces where no view sees the mesh. If the colours of less than half of the samples are known, the
// pixel has none (0 0 0 0).
//
// Shade: 1 + 254 max(0, n . l), where n is the normal of the surface at the pixel's centre and l
// the direction to the light, at 45 degrees above the upper left. n follows from the differences of
// the heights of the 3 x 3 pixels around the pixel (Horn, 1981); neighbours without surface get the
// height of the pixel.
//
// Pixels do not depend on the size of the blocks.
MapBlock make_block(const MapContent& content, const FaceBins& bins, std::size_t block,
                    int samples);

// The memory [bytes] of make_block() with its result, for blocks of this size.
std::uint64_t bytes_of_block(int block_size, int samples);

}  // namespace axial::map
