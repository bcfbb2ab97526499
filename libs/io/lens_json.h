// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: a lens's distortion in JSON (lenses of a scene, side files of depth maps).
#pragma once

#include "io/port_json.h"
#include "refractive/lens_distortion.h"

namespace axial::io {

// Error for unknown keys, types other than "perspective" and "fisheye", too many coefficients, and
// a "spread" or first radial coefficient that is not positive. What is not there is as in a
// straight lens.
refractive::LensDistortion<double> distortion_from_json(const JsonPlace& place);
nlohmann::json distortion_to_json(const refractive::LensDistortion<double>& distortion);

}  // namespace axial::io
