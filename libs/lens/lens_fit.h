// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the matcher's lens model to lenses of other models.
#pragma once

#include <functional>
#include <optional>

#include "refractive/lens_distortion.h"

namespace axial::lens {

// Fits the rational function of the matcher's fisheye to a lens without tangential distortion.
// `radius(theta)` is the distance from the principal point, divided by the focal length, at which
// the lens images a direction `theta` [rad] off its axis, for 0 < theta <= widest < pi/2. Nothing
// if the fit differs by more than `tolerance` (also divided by the focal length) at any angle, or
// has a pole.
std::optional<refractive::LensDistortion<double>> fitted_fisheye(
    const std::function<double(double theta)>& radius, double widest, double tolerance);

}  // namespace axial::lens
