// SPDX-License-Identifier: GPL-3.0-or-later
// The lens that a pinhole engine needs for photographs through a port.
#pragma once

#include "pose/bundle/photograph_camera.h"

namespace axial::pose {

// A lens without a port that images points nearly as a lens behind its port does.
struct EffectiveLens {
  lens::Lens lens;     // of the model OPENCV or OPENCV_FISHEYE
  double rms = 0;      // RMS distance between the images of both, over the photograph [px]
  double largest = 0;  // the largest of these distances [px]
};

// Fits a lens to `camera`, whose scene is about `distance` [m] away: to the rays of pixels over the
// whole photograph, at 0.7 and at 1.4 times this distance. The fitted camera may move and
// turn against the photograph's camera, because rays behind a port do not meet in the camera
// centre; bundle adjustment moves poses in the same way. Of both models, the one with the smaller
// error is taken; OPENCV if the errors differ by less than 1 %. A camera without a port and with a
// lens of another model gets such a lens, too.
//
// Throws an Error if `distance` is not positive, or if fewer than half of the pixels have rays.
EffectiveLens effective_lens(const HousedCamera& camera, double distance);

}  // namespace axial::pose
