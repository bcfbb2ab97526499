// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras with their poses.
#pragma once

#include "axial/scene.h"

namespace axial::geometry {

// The camera of a photograph, at the resolution at which the photograph is used, with its pose in
// the frame of the mesh or of the scene.
struct PosedCamera {
  CameraModel camera;
  Pose pose;
};

}  // namespace axial::geometry
