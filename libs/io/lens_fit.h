// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: lenses in other words than the matcher's, in its own.
#pragma once

#include <functional>
#include <optional>

#include "refractive/lens_distortion.h"

namespace axial::io {

// The matcher's fisheye that images as a lens without tangential distortion does. `radius`: how far
// from the principal point, over the focal length, the lens images what lies `theta` [rad] off its
// axis, for 0 < theta <= widest < 90 degrees. The matcher's rational function is fitted to it;
// nothing where it misses by more than `tolerance` anywhere (over the focal length, too) or has a
// pole.
std::optional<refractive::LensDistortion<double>> fitted_fisheye(
    const std::function<double(double theta)>& radius, double widest, double tolerance);

}  // namespace axial::io
