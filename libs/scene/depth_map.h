// SPDX-License-Identifier: GPL-3.0-or-later
// A depth map: for every pixel of one image a depth, a normal and a confidence.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial {

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

// The memory [bytes] of a map of `pixels` pixels: of the depths alone, and of depths, normals and
// confidences together.
constexpr std::uint64_t bytes_of_depths(std::uint64_t pixels) {
  return 4 * pixels;
}
constexpr std::uint64_t bytes_of_map(std::uint64_t pixels) {
  return (4 + 12 + 4) * pixels;
}

}  // namespace axial
