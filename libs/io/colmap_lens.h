// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP's lens models: projection of a direction in air, and the pinhole that replaces the lens.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "io/colmap.h"
#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// Projects the in-air direction (u, v, 1) to a pixel of `camera` (pixel centres at integers). NaN
// where the model is not defined. Models and order of parameters are those of COLMAP's
// documentation, up to EUCM. EQUIRECTANGULAR, which is no perspective camera, and METASHAPE_FISHEYE
// are not supported. Error for a model that is not supported or a wrong number of parameters.
Eigen::Vector2d image_direction(const ColmapCamera& camera, double u, double v);

// The inverse of image_direction, with the derivative of image_direction at the result.
struct ImagedDirection {
  Eigen::Vector2d direction;   // (u, v)
  Eigen::Matrix2d derivative;  // d(pixel)/d(u, v) there
};

// Returns the in-air direction that `camera` projects to `pixel` (centres at integers). Newton's
// method starts from the direction of the undistorted lens. Nothing if no direction projects to the
// pixel, if the method does not converge, or if the lens folds back between the axis and the
// direction. Errors as for image_direction.
std::optional<ImagedDirection> direction_at(const ColmapCamera& camera,
                                            const Eigen::Vector2d& pixel);

// The lens without its distortion: focal lengths and principal point (pixel centres at integers).
refractive::PinholeLens<double> undistorted_lens(const ColmapCamera& camera);

// Returns the distortion of the lens relative to undistorted_lens(), in the form that the matcher
// uses. The perspective and fisheye polynomials and FOV are exact. The division models and EUCM are
// fitted, with an error of at most 1e-4 px up to the image corners. Nothing for pinholes, for
// RAD_TAN_THIN_PRISM_FISHEYE, and for lenses that cannot be fitted so well.
std::optional<refractive::LensDistortion<double>> lens_distortion(const ColmapCamera& camera);

// Returns the lens if `camera` is a pinhole: PINHOLE, SIMPLE_PINHOLE, or a perspective lens model
// whose distortion parameters are all exactly zero. Pixel centres at integers.
std::optional<refractive::PinholeLens<double>> pinhole_lens(const ColmapCamera& camera);

// Returns a pinhole that replaces `camera` without a black border in the undistorted image. It has
// the camera's size, principal point and ratio of focal lengths. Its focal length is the shortest,
// between half and four times that of the camera, for which every pixel lies inside the image of
// `camera`. Error that starts with `name` if there is none.
refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera, const std::string& name);

// Returns, for every pixel of the pinhole, its position in the image of `camera`: the map for
// cv::remap.
cv::Mat2f undistortion_map(const ColmapCamera& camera,
                           const refractive::PinholeLens<double>& pinhole);

}  // namespace axial::io
