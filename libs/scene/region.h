// SPDX-License-Identifier: GPL-3.0-or-later
// The region of interest: the part of the scene at which the cameras look.
#pragma once

#include <optional>

#include "axial/scene_options.h"

namespace axial {

// Estimates the region as an axis-aligned box [world units]. Let c be the point at which the
// cameras look, estimated from the poses of the calibrated cameras, and R the distance from c to
// the farthest camera. The box encloses the sparse points whose z-depth in at least one of their
// images is below 2 R. The box is then enlarged by 10 %, and no side is shorter than a tenth of the
// longest.
//
// Returns nothing if the mode is `off`, if fewer than 3 cameras are calibrated, if the box would
// enclose no point, or if the mode is `adaptive` and the cameras do not surround c. Cameras
// surround c if c is in front of all of them and the mean of their viewing directions is no longer
// than sqrt(1/2).
std::optional<OrientedBox> estimate_region(const Scene& scene, RegionMode mode);

// Returns `region` with another size around its centre. `border`: the value of the option
// --roi-border. A positive `border` multiplies the half extents. A negative `border` adds -border
// [world units] to each half extent. 0 changes nothing.
OrientedBox with_border(const OrientedBox& region, double border);

}  // namespace axial
