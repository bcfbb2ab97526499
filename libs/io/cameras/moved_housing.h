// SPDX-License-Identifier: GPL-3.0-or-later
// A housing after its cameras have been moved by a similarity.
#pragma once

#include "io/cameras/housing.h"
#include "scene/decompositions.h"

namespace axial::io {

// Returns the housing that fits the poses after they have been moved by `similarity`, which maps
// world coordinates to world coordinates. `housing` is in world coordinates before and after. Water
// surfaces are moved by `similarity`. Other ports are fixed to the camera, so that only their
// lengths (distance, radius, thickness) can change. If `scale_ports` is true, the lengths are
// multiplied by the scale, so that every moved point keeps its pixel. Otherwise the lengths stay.
Housing moved(const Similarity& similarity, Housing housing, bool scale_ports);

}  // namespace axial::io
