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

// The distortion parameters of a camera, in COLMAP's order: COLMAP's parameters without focal
// lengths and principal point. Precondition of all functions: their number is that of the model.
using Parameters = std::span<const double>;

// The formulas of one camera model of COLMAP.
struct Model {
  std::string_view name;  // "PINHOLE", "OPENCV", ...
  // Projects the in-air direction (u, v, 1), where (u, v) = `direction`, to the image plane. In the
  // result, `point` is the image point at the focal length 1 and the principal point (0, 0), and
  // `by` is the derivative of `point` by (u, v). Both are NaN where the model is not defined.
  refractive::PlanePoint<double> (*distort)(Parameters, const Eigen::Vector2d& direction);
  // True if a lens of this model is a pinhole when all its distortion parameters are zero.
  bool flat;
  // Converts the distortion to the matcher's form, exactly up to rounding. Null if the matcher's
  // form cannot represent this model.
  refractive::LensDistortion<double> (*bent)(Parameters){};
  // True if the matcher's fisheye can be fitted to lenses of this model (lens_fit.h).
  bool radial = false;
};

// Returns the model that COLMAP calls `name`. The models are those of COLMAP 4.1 except
// EQUIRECTANGULAR, which is no perspective camera. Null for every other name. The models exist
// until the program ends.
const Model* find_model(std::string_view name);

// A model of COLMAP that describes a lens in the matcher's form: the name of the model and its
// distortion parameters (see Parameters). The focal lengths of this model are `focal_factor` times
// the focal lengths of the lens in the matcher's form. The principal points are equal.
struct ModelOf {
  std::string_view name;
  std::vector<double> parameters;
  double focal_factor = 1;
};

// The inverse of Model::bent: returns the model that images every direction as the distortion
// `bent` does, up to rounding. The models OPENCV, FULL_OPENCV, OPENCV_FISHEYE, THIN_PRISM_FISHEYE
// and FOV are tried in this order. Empty if none of them fits, for example for a distortion that
// lens_distortion() (lens.h) has fitted.
std::optional<ModelOf> model_of(const refractive::LensDistortion<double>& bent);

}  // namespace axial::lens
