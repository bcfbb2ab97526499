// SPDX-License-Identifier: GPL-3.0-or-later
// The exact images of all vertices in one view. Between the vertices of a face, which is small,
// positions in the image are interpolated.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "refine/refine.h"

namespace axial::refine {

struct VertexImage {
  float x = 0, y = 0;  // [px]
  float depth = -1;    // along the ray from its origin [mesh units]; negative: not visible
  Eigen::Matrix<float, 2, 3, Eigen::RowMajor> by_point;  // d(x, y)/d(vertex) in the mesh's frame

  bool visible() const { return depth > 0; }
  // The direction in the scene medium of the ray through the vertex, away from the camera: the
  // direction in which the vertex can move without moving in the image.
  Eigen::Vector3f ray() const;
};

// A vertex outside the image by more than an eighth of its longer side counts as not visible.
std::vector<VertexImage> vertex_images(std::span<const Eigen::Vector3f> vertices, const View& view);

}  // namespace axial::refine
