// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads and writes the distortion of a lens in JSON. The lens files of scenes
// and the side files of depth maps contain such distortions.
#pragma once

#include "private/cameras/port_json.h"
#include "private/only_for_io.h"
#include "refractive/lens_distortion.h"

namespace axial::io {

// Reads or writes a distortion (docs/formats.md). Keys that are missing keep the values of a lens
// without distortion. Error for an unknown key, a type other than "perspective" and "fisheye", too
// many coefficients, or a "spread" or first radial coefficient that is not positive.
refractive::LensDistortion<double> distortion_from_json(const JsonPlace& place);
nlohmann::json distortion_to_json(const refractive::LensDistortion<double>& distortion);

}  // namespace axial::io
