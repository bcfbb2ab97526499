// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "scene/camera_model.h"
#include "scene/pose.h"
#include "scene/scene.h"

namespace axial::geometry {

// The camera of a photograph, at the resolution at which the photograph is used, with its pose in
// the frame of the mesh or of the scene.
struct PosedCamera {
  CameraModel camera;
  Pose pose;
};

// The cameras of the calibrated images, in the order of the images.
std::vector<PosedCamera> posed_cameras(const Scene& scene);

}  // namespace axial::geometry
