// SPDX-License-Identifier: GPL-3.0-or-later
// Shows errors as colours and in pictures.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "evaluate/depth_evaluation.h"
#include "evaluate/views.h"
#include "scene/scene.h"

namespace axial::evaluate {

// The colour of an error in all error pictures, by OpenCV's colour map "turbo": dark violet for 0,
// then blue, cyan, green and yellow, and dark red for `upper` and larger errors. Black for an error
// that is not finite.
Rgb error_color(float error, double upper);
std::vector<Rgb> error_colors(std::span<const float> errors, double upper);

// The viewpoint of a picture of a cloud. The camera frame is that of Pose. The focal lengths are in
// pixels, or in pixels per metre for parallel rays (orthographic).
struct Viewpoint {
  Pose pose;
  int width = 0, height = 0;
  double focal_x = 0, focal_y = 0, centre_x = 0, centre_y = 0;
  bool orthographic = false;
};

// Returns the viewpoint at the pose of `view`. The picture is `width` pixels wide and has the
// aspect ratio of the camera. The port and the lens distortion of the camera are left out.
Viewpoint viewpoint_of(const View& view, int width);

// Returns an orthographic viewpoint. The viewing direction is the principal axis along which the
// points extend least. If there are normals, the viewing direction is opposite to their mean. The
// points fill 95 % of the picture's width or height, whichever limits the scale. Along each image
// axis, 1 % of the points at either end may lie outside the picture.
Viewpoint principal_viewpoint(std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals, int width, int height);

// Draws the points as small squares on white. The nearest point covers the others. The squares are
// smaller if the picture contains more points, so that the picture of a dense cloud has no gaps.
cv::Mat3b draw_cloud(std::span<const Eigen::Vector3f> positions, std::span<const Rgb> colors,
                     const Viewpoint& viewpoint);

// Returns `picture` with a colour bar of errors below. The ticks are in mm. `upper`: error of the
// last colour [m].
cv::Mat3b with_error_scale(const cv::Mat3b& picture, double upper);

// Draws depth, truth and absolute error side by side, each with a caption. Maps wider than
// `panel_width` pixels are reduced to this width. Depth and truth share one scale (2nd to 98th
// percentile of the truth). `upper`: error of the last colour [m]. Missing pixels are dark grey.
cv::Mat3b draw_depth_comparison(const cv::Mat1f& estimate, const DepthEvaluation& evaluation,
                                double upper, int panel_width = 640);

}  // namespace axial::evaluate
