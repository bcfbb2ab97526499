// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a scene that consist of pixels: depth maps, and meshes with textures.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "axial/scene.h"

namespace axial {

// A depth map: for every pixel of one image a depth, a normal and a confidence.
//
// Depth is lambda of the paper's eq. (4): the distance [m] along the pixel's ray in the scene
// medium, from the ray's origin on the axis. For a camera without a port this is the distance from
// the camera centre. Files of depth maps contain z-depth instead. The functions that read and write
// these files convert the depths.
struct DepthMap {
  std::string image_path;
  std::vector<std::uint32_t> ids;  // global ids: the reference view, then its source views
  CameraModel camera;              // at the resolution of the depth map
  Pose pose;                       // of the camera in the world
  float min_depth = 0;             // range of depths that was searched [m]
  float max_depth = 0;
  cv::Mat1f depth;       // [m]; 0: invalid
  cv::Mat3f normal;      // unit, camera frame, facing the camera (n . direction < 0); 0: invalid
  cv::Mat1f confidence;  // empty, or one value per pixel: higher is better

  int width() const { return depth.cols; }
  int height() const { return depth.rows; }
};

// A triangle mesh with one or more texture images. Corner k of face f has the colour that the
// texture texture_of[f] has at the pixel uv[f][k]. Inside a face, uv is linear. Pixels are (x, y)
// with x to the right, y down, and pixel centres at integers: the upper left corner of a texture is
// (-0.5, -0.5). Files of textured meshes have other conventions. io/textured converts the
// coordinates.
struct TexturedMesh {
  using Corners = std::array<Eigen::Vector2f, 3>;

  Mesh mesh;
  std::vector<Corners> uv;                // one per face [px]
  std::vector<std::uint32_t> texture_of;  // one per face: index into `textures`
  std::vector<cv::Mat3b> textures;        // B G R
};

}  // namespace axial
