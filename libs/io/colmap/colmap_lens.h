// SPDX-License-Identifier: GPL-3.0-or-later
// The lens of a COLMAP camera, for the functions of lens/lens.h.
#pragma once

#include <string>

#include "io/colmap/colmap.h"
#include "lens/lens.h"

namespace axial::io {

// Returns the lens of `camera`, with pixel centres at integers. Error for a wrong number of
// parameters and for a model that is not supported. EQUIRECTANGULAR, which is not a perspective
// camera, and METASHAPE_FISHEYE are not supported.
lens::Lens lens_of(const ColmapCamera& camera);

// Returns lens::pinhole_inside of the camera's lens. Error that starts with `name` if the lens has
// no such pinhole. Other errors as for lens_of.
refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera, const std::string& name);

}  // namespace axial::io
