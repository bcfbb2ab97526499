// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the matcher's form of a fisheye lens (refractive::LensDistortion) to lenses of other models.
#pragma once

#include <functional>
#include <optional>

#include "refractive/lens_distortion.h"

namespace axial::lens {

// Fits the rational function of the matcher's fisheye to a lens without tangential distortion.
// `radius` describes this lens. It maps the angle theta [rad] of a direction from the axis to the
// distance of the direction's image from the principal point, divided by the focal length. The fit
// covers 0 < theta <= widest. Precondition: 0 < widest < pi/2 [rad]. `tolerance` is the largest
// error of the fit, in the unit of the result of radius(). Empty if the error exceeds `tolerance`
// at any of 1000 tested angles, or if the fit has a pole at a tested angle.
std::optional<refractive::LensDistortion<double>> fitted_fisheye(
    const std::function<double(double theta)>& radius, double widest, double tolerance);

}  // namespace axial::lens
