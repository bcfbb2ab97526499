// SPDX-License-Identifier: GPL-3.0-or-later
// The images of all vertices in one view, by the exact projection. Positions inside a face are
// interpolated between the images of its corners, because faces are small.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/refine.h"

namespace axial::refine {

// The image of one vertex in a view.
struct VertexImage {
  float x = 0, y = 0;  // [px]
  float depth = -1;    // along the ray, from its origin [mesh units]; negative: not visible
  Eigen::Matrix<float, 2, 3, Eigen::RowMajor> by_point;  // d(x, y)/d(vertex) in the mesh's frame

  bool visible() const { return depth > 0; }
  // The unit direction, in the mesh's frame, of the ray through the vertex. The ray is the part of
  // the light path in the scene medium, and points away from the camera. The image of the vertex
  // does not move if the vertex moves along this direction. Precondition: visible().
  Eigen::Vector3f ray() const;
};

// Projects every vertex, in the frame of the mesh, into `view`. Returns one image per vertex. A
// vertex is not visible if it is behind the camera, if the camera has no image of it, or if it is
// projected beyond the image's border by more than an eighth of the image's longer side. Occlusion
// is not considered.
std::vector<VertexImage> vertex_images(std::span<const Eigen::Vector3f> vertices,
                                       const PosedCamera& view);

}  // namespace axial::refine
