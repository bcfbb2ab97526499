// SPDX-License-Identifier: GPL-3.0-or-later
// The region of interest: what the cameras look at (OPENMVS_FACTS 6.8).
#pragma once

#include <optional>

#include "scene/scene.h"

namespace axial {

enum class RegionMode {
  off = 0,
  on = 1,       // whenever it can be computed
  adaptive = 2  // only when the cameras surround something: otherwise unbounded
};

// An axis-aligned box around the sparse points near the centre of attention, in world units. None
// if there are fewer than 3 calibrated cameras or no points, or the mode says so.
std::optional<OrientedBox> estimate_region(const Scene& scene, RegionMode mode);

// --roi-border: `border` > 0 multiplies the half extents, < 0 adds -border to each of them [world
// units], 0 changes nothing.
OrientedBox with_border(const OrientedBox& region, double border);

}  // namespace axial
