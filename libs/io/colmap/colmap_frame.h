// SPDX-License-Identifier: GPL-3.0-or-later
// Moves models of COLMAP into a local frame and back.
#pragma once

#include "io/colmap/colmap.h"
#include "scene/local_frame.h"

namespace axial::io {

// Moves a model from world coordinates into the frame that frame_of() chooses for its camera
// centres and points, and returns this frame. If the model is near the origin of the world, the
// frame is the world and the model stays unchanged.
LocalFrame enter_local_frame(ColmapModel& model);

// enter() moves the camera centres and the points of a model from world coordinates into `frame`.
// leave() moves them from `frame` to world coordinates.
void enter(const LocalFrame& frame, ColmapModel& model);
void leave(const LocalFrame& frame, ColmapModel& model);

}  // namespace axial::io
