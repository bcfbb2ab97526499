// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: the ellipse of a dot, to a small part of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace axial::targets {

// An ellipse. `to_circle` is symmetric; it maps the offset of a point on the ellipse from the
// centre to a unit vector. Pixel centres are integers.
struct Ellipse {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d to_circle = Eigen::Matrix2d::Identity();
};

// The ellipse with the axes and the angle of OpenCV's `box`.
Ellipse ellipse_of(const cv::RotatedRect& box);

// The half axes of the ellipse [px], the smaller first.
Eigen::Vector2d half_axes(const Ellipse& ellipse);

// The pixels of the ellipse that is `reach` times as large. The box may reach over a picture.
cv::Rect box_of(const Ellipse& ellipse, double reach);

struct DotFit {
  Ellipse dot;
  Eigen::Matrix2d covariance;  // of the centre [px^2]
  double outside = 0, inside = 0;
  double blur = 1;
  double noise = 0;  // standard deviation of the residuals [brightness]
};

// Fits the outline of a bright or dark dot, begun at `start`, to the pixels within 1.6 times its
// radius. Nothing if the dot is cut off by the border of `picture`, if the fit moves the centre by
// more than half the radius, or if the pixels do not determine the ellipse.
std::optional<DotFit> fit_dot(const cv::Mat1f& picture, const Ellipse& start);

}  // namespace axial::targets
