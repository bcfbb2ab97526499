// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a mesh into a view: finds for every pixel the face that the pixel shows, and the point on
// this face.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "refine/topology.h"
#include "refine/vertex_images.h"

namespace axial::refine {

inline constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;  // Raster::face() of a pixel without a face

// Depth and face of the nearest surface at every pixel centre, in the size of the view's image.
struct Raster {
  cv::Mat1f depth;                   // along the ray [mesh units]; infinite where there is no face
  cv::Mat_<std::int32_t> face_bits;  // the bits of face()

  // The index of the face that the pixel (x, y) shows, or kNoFace.
  std::uint32_t face(int x, int y) const { return static_cast<std::uint32_t>(face_bits(y, x)); }
};

// Draws the faces whose three corners are visible. `images`: of the mesh's vertices in the view.
// `size`: of the view's image [px]. Inside a face, positions and depths are interpolated linearly
// in the image. Of several faces at the same depth, the face with the smallest index is drawn.
Raster draw(const Mesh& mesh, std::span<const VertexImage> images, cv::Size size);

// Barycentric weights in the image, at the position (x, y) [px], of the corners b (weight b1) and c
// (weight b2) of the face whose corners have the images a, b and c. The weight of corner a is 1 -
// b1 - b2. The face must have an area in the image.
struct Barycentric {
  float b1, b2;
};
Barycentric barycentric(const VertexImage& a, const VertexImage& b, const VertexImage& c, float x,
                        float y);

// For each face, the list of the pixels that show the face. A pixel (x, y) has the number
// y * width + x, and each list is in ascending order. `faces`: the number of faces of the mesh.
geometry::Lists<> pixels_of_faces(const Raster& raster, std::size_t faces);

}  // namespace axial::refine
