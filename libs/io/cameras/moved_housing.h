// SPDX-License-Identifier: GPL-3.0-or-later
// A housing after its cameras have been moved by a similarity.
#pragma once

#include "io/cameras/housing.h"
#include "scene/decompositions.h"

namespace axial::io {

// Returns `housing` for poses that `similarity`, from world to world coordinates, has moved. Water
// surfaces move with the poses. Ports that the cameras carry are fixed to the camera, so that only
// their lengths can change: with `scale_ports` they are multiplied by the scale, and every point
// keeps its pixel. Without it they keep their lengths.
Housing moved(const Similarity& similarity, Housing housing, bool scale_ports);

}  // namespace axial::io
