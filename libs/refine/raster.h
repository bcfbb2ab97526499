// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a mesh into a view: the face and the place on the face that every pixel shows.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "refine/topology.h"
#include "refine/vertex_images.h"

namespace axial::refine {

inline constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;

// Depth and face of the nearest surface at every pixel centre, in the size of the view's image.
struct Raster {
  cv::Mat1f depth;  // along the ray; infinite where there is no face
  cv::Mat_<std::int32_t> face_bits;

  std::uint32_t face(int x, int y) const { return static_cast<std::uint32_t>(face_bits(y, x)); }
};

// Draws all faces whose corners are visible. Of faces at the same depth, the first one wins.
Raster draw(const Mesh& mesh, std::span<const VertexImage> images, cv::Size size);

// The weights of the corners 1 and 2 of the face at the pixel (x, y); that of corner 0 is the rest.
struct Barycentric {
  float b1, b2;
};
Barycentric barycentric(const VertexImage& a, const VertexImage& b, const VertexImage& c, float x,
                        float y);

// The pixels (y * width + x) that show each face, in ascending order.
Lists pixels_of_faces(const Raster& raster, std::size_t faces);

}  // namespace axial::refine
