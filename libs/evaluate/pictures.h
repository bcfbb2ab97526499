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

// The colour of an error in all error pictures: OpenCV's "turbo" map from dark violet (0) through
// blue, cyan, green and yellow to dark red (`upper` and beyond). Black for an error that is not
// finite.
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

// The viewpoint of the camera of `view` in air with a lens without distortion, `width` pixels wide.
Viewpoint viewpoint_of(const View& view, int width);

// An orthographic viewpoint along the direction in which the points extend least, against their
// normals if there are any. The points fill 95 % of the picture's width or height, without the
// outermost hundredth of the points at each end.
Viewpoint principal_viewpoint(std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals, int width, int height);

// Draws the points as small squares on white; the nearest point covers the others. The size of the
// squares follows from the number of points, so that dense clouds look closed.
cv::Mat3b draw_cloud(std::span<const Eigen::Vector3f> positions, std::span<const Rgb> colors,
                     const Viewpoint& viewpoint);

// Returns `picture` with the error ramp and its ticks [mm] below.
cv::Mat3b with_error_scale(const cv::Mat3b& picture, double upper);

// Draws depth, truth and absolute error side by side, each with a caption and at most `panel_width`
// pixels wide. Depth and truth share one scale (2nd to 98th percentile of the truth). Missing
// pixels are dark grey.
cv::Mat3b draw_depth_comparison(const cv::Mat1f& estimate, const DepthEvaluation& evaluation,
                                double upper, int panel_width = 640);

}  // namespace axial::evaluate
