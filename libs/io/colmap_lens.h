// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP's lens models: where they image a direction, and the pinhole that replaces them.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "io/colmap.h"
#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// Where `camera` images the in-air direction (u, v, 1), in pixels with centres at integers. NaN
// where the model does not define it. Models and parameter order as COLMAP documents them, up to
// EUCM; all of them but EQUIRECTANGULAR (which is no perspective camera) and METASHAPE_FISHEYE.
// Error for a model that is not supported or a wrong number of parameters.
Eigen::Vector2d image_direction(const ColmapCamera& camera, double u, double v);

// The inverse of image_direction.
struct ImagedDirection {
  Eigen::Vector2d direction;   // (u, v)
  Eigen::Matrix2d derivative;  // d(pixel)/d(u, v) there
};

// What in-air direction `camera` images at `pixel` (centres at integers). Nothing where the model
// has none, or none that is found from the undistorted one. Error as image_direction.
std::optional<ImagedDirection> direction_at(const ColmapCamera& camera,
                                            const Eigen::Vector2d& pixel);

// The lens without its distortion: focal lengths and principal point. Pixel centres at integers.
refractive::PinholeLens<double> undistorted_lens(const ColmapCamera& camera);

// How the lens bends the picture of undistorted_lens(), for models that the matcher follows: the
// polynomials, perspective and fisheye, and FOV; and, by a fit that is right to 1e-4 px as far as
// the image's corners, the division models and EUCM. Nothing for RAD_TAN_THIN_PRISM_FISHEYE,
// pinholes, and lenses that no fit is right for.
std::optional<refractive::LensDistortion<double>> lens_distortion(const ColmapCamera& camera);

// The lens if `camera` is a pinhole: PINHOLE, SIMPLE_PINHOLE, or a lens model whose distortion is
// exactly zero. Pixel centres at integers.
std::optional<refractive::PinholeLens<double>> pinhole_lens(const ColmapCamera& camera);

// A pinhole of the same size, principal point and ratio of focal lengths, zoomed out as far as
// every pixel of its image still lies inside the image of `camera` (at most to half, at least to
// four times the focal length), so that an undistorted image has no black border. Error, starting
// with `name`, if there is none: the lens sees more than a plane can show.
refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera, const std::string& name);

// For every pixel of the pinhole the position in `camera`'s image: the map of cv::remap.
cv::Mat2f undistortion_map(const ColmapCamera& camera,
                           const refractive::PinholeLens<double>& pinhole);

}  // namespace axial::io
