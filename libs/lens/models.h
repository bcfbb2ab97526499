// SPDX-License-Identifier: GPL-3.0-or-later
// The formulas of COLMAP's lens models, and conversions between these models and the matcher's
// form of a lens (refractive/lens_distortion.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "refractive/lens_distortion.h"

namespace axial::lens {

// The distortion parameters of a camera, in COLMAP's order, without focal lengths and principal
// point.
using Parameters = std::span<const double>;

struct Model {
  std::string_view name;  // "PINHOLE", "OPENCV", ...
  // Projects the in-air direction (u, v, 1) to the image plane. The result is the point before
  // focal lengths and principal point are applied, and the derivative of the point by (u, v). Both
  // are NaN where the model is not defined.
  refractive::PlanePoint<double> (*distort)(Parameters, const Eigen::Vector2d& direction);
  // True if a lens of this model is a pinhole when all its distortion parameters are zero.
  bool flat;
  // Converts the distortion to the matcher's form without error. Null if the matcher's form cannot
  // represent this model.
  refractive::LensDistortion<double> (*bent)(Parameters){};
  // True if the matcher's fisheye can be fitted to lenses of this model (lens_fit.h).
  bool radial = false;
};

// Returns the model that COLMAP calls `name`. The models are those of the table in models.cpp,
// from SIMPLE_PINHOLE to EUCM. Null for every other name, including EQUIRECTANGULAR, which is no
// perspective camera.
const Model* find_model(std::string_view name);

// A model of COLMAP with its distortion parameters. The focal lengths of this model are
// `focal_factor` times the focal lengths of the lens in the matcher's form.
struct ModelOf {
  std::string_view name;
  std::vector<double> parameters;
  double focal_factor = 1;
};

// The inverse of Model::bent: returns the model that images every direction as `bent` does, up to
// rounding. The models OPENCV, FULL_OPENCV, OPENCV_FISHEYE, THIN_PRISM_FISHEYE and FOV are tried in
// this order. Empty if none of them fits, for example for a distortion that lens_distortion()
// (lens.h) has fitted.
std::optional<ModelOf> model_of(const refractive::LensDistortion<double>& bent);

}  // namespace axial::lens
