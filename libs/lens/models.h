// SPDX-License-Identifier: GPL-3.0-or-later
// The formulas of COLMAP's lens models, and the same lenses in the matcher's form.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "refractive/lens_distortion.h"

namespace axial::lens {

// The distortion parameters of a camera in the order of COLMAP's documentation: without focal
// lengths and principal point.
using Parameters = std::span<const double>;

struct Model {
  std::string_view name;  // "PINHOLE", "OPENCV", ...
  // The point that the in-air direction (u, v, 1) has in the image, before focal lengths and
  // principal point are applied, and its derivative by (u, v). NaN where the model is not defined.
  refractive::PlanePoint<double> (*distort)(Parameters, const Eigen::Vector2d& direction);
  bool flat;  // a pinhole if all distortion parameters are zero
  // The lens in the matcher's form. Null: the matcher does not have this model.
  refractive::LensDistortion<double> (*bent)(Parameters){};
  bool radial = false;  // the matcher's fisheye can be fitted to the model
};

// The models of COLMAP's documentation, up to EUCM. Null for other names and for EQUIRECTANGULAR,
// which is no perspective camera.
const Model* find_model(std::string_view name);

// A model of COLMAP's documentation with its distortion parameters, for a pinhole whose focal
// lengths are `focal_factor` times those of the lens in the matcher's form.
struct ModelOf {
  std::string_view name;
  std::vector<double> parameters;
  double focal_factor = 1;
};

// The model that images every direction as `bent` does, up to rounding: the inverse of Model::bent.
// The result is OPENCV, FULL_OPENCV, OPENCV_FISHEYE, THIN_PRISM_FISHEYE or FOV, the first one that
// fits. Nothing if none of them fits, as for lenses that were fitted (lens_distortion in lens.h).
std::optional<ModelOf> model_of(const refractive::LensDistortion<double>& bent);

}  // namespace axial::lens
