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

// The colour of an unsigned error in all error pictures, by OpenCV's colour map "turbo": dark
// violet for 0, then blue, cyan, green and yellow, and dark red for `upper` and larger errors.
// Black for an error that is not finite. `error` and `upper` have the same unit. Precondition:
// `upper` is positive.
Rgb error_color(float error, double upper);

// The colour of each error, as error_color() gives it, in the order of `errors`.
std::vector<Rgb> error_colors(std::span<const float> errors, double upper);

// The viewpoint of a picture of a cloud. Let (x, y, z) be a point in the camera frame of `pose`.
// Its image is at (focal_x * x / z + centre_x, focal_y * y / z + centre_y) [px]. If `orthographic`,
// the rays are parallel, and the image is at (focal_x * x + centre_x, focal_y * y + centre_y).
struct Viewpoint {
  Pose pose;
  int width = 0, height = 0;  // size of the picture [px]
  // The focal lengths are in pixels, or in pixels per metre if `orthographic`. The centre is in
  // pixels.
  double focal_x = 0, focal_y = 0, centre_x = 0, centre_y = 0;
  bool orthographic = false;
};

// Returns the viewpoint at the pose of `view`. The picture is `width` pixels wide and has the
// aspect ratio of the camera. The port and the lens distortion of the camera are left out.
Viewpoint viewpoint_of(const View& view, int width);

// Returns an orthographic viewpoint for a picture of `width` x `height` pixels. The viewing
// direction is parallel to the principal axis along which the points extend least. Of the two
// opposite directions, the one against the mean of `normals` is taken. If `normals` is empty,
// either may be taken. The image's x axis is the principal axis along which the points extend most.
// The scale is the largest at which the range of the points from the 1st to the 99th percentile
// covers at most 95 % of the picture along each image axis. The outermost points may lie outside
// the picture. The axes and percentiles are those of a random subsample of at most 50000 points.
Viewpoint principal_viewpoint(std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals, int width, int height);

// Draws the points as squares on white. All squares have the same side: 1.5 times the mean spacing
// of the points in the picture, at least 2 and at most 7 pixels. The nearest point covers the
// others. Points behind a viewpoint with perspective are left out. Precondition: `colors` has one
// colour for each point, in the order of `positions`.
cv::Mat3b draw_cloud(std::span<const Eigen::Vector3f> positions, std::span<const Rgb> colors,
                     const Viewpoint& viewpoint);

// Returns `picture` with a colour bar below it, which shows the colours of error_color() from 0 to
// `upper` [m]. The result is 44 pixels higher than `picture`. The ticks are in mm.
cv::Mat3b with_error_scale(const cv::Mat3b& picture, double upper);

// Draws estimate, truth and absolute error side by side, each with a caption. Maps wider than
// `panel_width` pixels are reduced to this width. The distances of estimate and truth have one
// colour scale, from the 2nd to the 98th percentile of the truth. The errors have the colours of
// error_color() for `upper` [m]. Missing pixels are dark grey. Precondition: `evaluation` is the
// result of evaluate_depth() for `estimate`.
cv::Mat3b draw_depth_comparison(const cv::Mat1f& estimate, const DepthEvaluation& evaluation,
                                double upper, int panel_width = 640);

}  // namespace axial::evaluate
