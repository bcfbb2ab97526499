// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP's lens models: where they image a direction, and the pinhole that replaces them.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "io/colmap.h"
#include "refractive/pinhole_camera.h"

namespace axial::io {

// Where `camera` images the in-air direction (u, v, 1), in pixels with centres at integers. NaN
// where the model does not define it. Models and parameter order as COLMAP documents them, up to
// EUCM; all of them but EQUIRECTANGULAR (which is no perspective camera) and METASHAPE_FISHEYE.
// Error for a model that is not supported or a wrong number of parameters.
Eigen::Vector2d image_direction(const ColmapCamera& camera, double u, double v);

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
