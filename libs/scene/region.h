// SPDX-License-Identifier: GPL-3.0-or-later
// The region of interest: the part of the scene at which the cameras look.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace axial {

enum class RegionMode {
  off = 0,
  on = 1,       // whenever it can be computed
  adaptive = 2  // only if the cameras surround an object; otherwise the scene is unbounded
};

// Estimates the region as an axis-aligned box [world units]. The centre of attention is estimated
// from the poses of the calibrated cameras. The box encloses the sparse points whose z-depth in one
// of their images is below twice the largest distance of a camera from the centre of attention. It
// is then enlarged by 10 %, and no side is shorter than a tenth of the longest. Empty if the mode
// is `off`, if fewer than 3 cameras are calibrated, if no point qualifies, or if the mode is
// `adaptive` and the cameras do not surround the centre of attention.
std::optional<OrientedBox> estimate_region(const Scene& scene, RegionMode mode);

// Enlarges `region` by the value of --roi-border: a positive `border` multiplies the half extents,
// a negative one adds -border [world units] to each of them, and 0 changes nothing.
OrientedBox with_border(const OrientedBox& region, double border);

}  // namespace axial
