// SPDX-License-Identifier: GPL-3.0-or-later
// Two cameras on one bar.
#pragma once

#include "simulate/presets/presets.h"

namespace axial::simulate {

struct SecondCamera {
  double base = 0.2;            // to the right of the first camera, along its x axis [m]
  double port_distance = 0.02;  // of its own flat port, which is else like that of the first [m]
  // How much later than the first camera it takes its photographs, in intervals between
  // photographs. It is then farther along the track of the first camera.
  double delay = 0;
};

// Appends a view of the second camera for each view, in the same order, and sets the port of the
// second camera. The velocity follows from the views before and after. Throws an Error if there are
// fewer than two views, for a water surface, for a dome, and for an impossible port.
void add_second_camera(Preset& preset, const SecondCamera& second);

}  // namespace axial::simulate
