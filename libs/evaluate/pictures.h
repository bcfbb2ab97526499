// SPDX-License-Identifier: GPL-3.0-or-later
// Errors as colours and as pictures.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "evaluate/depth_evaluation.h"
#include "evaluate/views.h"
#include "scene/scene.h"

namespace axial::evaluate {

// The colour ramp of all error pictures: OpenCV's "turbo", dark violet at 0 through blue, cyan,
// green and yellow to dark red at `upper` and beyond. Not finite: black.
Rgb error_color(float error, double upper);
std::vector<Rgb> error_colors(std::span<const float> errors, double upper);

// From where a cloud is looked at. Camera frame as in Pose; `focal` is in pixels, or for parallel
// rays (orthographic) in pixels per metre.
struct Viewpoint {
  Pose pose;
  int width = 0, height = 0;
  double focal_x = 0, focal_y = 0, centre_x = 0, centre_y = 0;
  bool orthographic = false;
};

// What the camera of `view` would see in air with a straight lens, `width` pixels wide.
Viewpoint viewpoint_of(const View& view, int width);

// Along the direction of least extent of the points, against their normals where there are any, so
// that all but their outermost hundredth on each side fill the picture.
Viewpoint principal_viewpoint(std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals, int width, int height);

// The points as little squares on white, the nearest in front. Their size follows the number of
// points, so that dense clouds look closed.
cv::Mat3b draw_cloud(std::span<const Eigen::Vector3f> positions, std::span<const Rgb> colors,
                     const Viewpoint& viewpoint);

// `picture` with the error ramp and its ticks [mm] below.
cv::Mat3b with_error_scale(const cv::Mat3b& picture, double upper);

// Depth beside truth beside absolute error, each with a caption, each at most `panel_width` pixels
// wide. Depths share one scale (2nd to 98th percentile of the truth); nothing: dark grey.
cv::Mat3b draw_depth_comparison(const cv::Mat1f& estimate, const DepthEvaluation& evaluation,
                                double upper, int panel_width = 640);

}  // namespace axial::evaluate
