// SPDX-License-Identifier: GPL-3.0-or-later
// The lens of a COLMAP camera, for the functions of lens/lens.h.
#pragma once

#include <string>

#include "io/colmap/colmap.h"
#include "lens/lens.h"

namespace axial::io {

// Returns the lens of `camera`, with pixel centres at integers. Error that names the id of the
// camera for a wrong number of parameters and for a model that is not supported. EQUIRECTANGULAR,
// which is not a perspective camera, and METASHAPE_FISHEYE are not supported.
lens::Lens lens_of(const ColmapCamera& camera);

// Returns the pinhole that replaces the lens of `camera` without a black border in the undistorted
// image: the result of lens::pinhole_inside(). Error that starts with `name`, the name of the
// model, if there is no such pinhole. Other errors as for lens_of.
refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera, const std::string& name);

}  // namespace axial::io
