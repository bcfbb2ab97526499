// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pose/adjust.h"

// How well the free numbers were measured; 0: not at all.
struct Sigmas {
  double normal_degrees = 0;
  double distance = 0, centre = 0;  // [m]
  double index = 0;
  double focal = 0;  // relative
};

// What --refine says, a list of normal, distance, centre, index and focal, and how well that was
// measured, into `adjust`. Error for another word; for normal or distance of a dome, or the centre
// of a flat port; for a sigma of what is not refined; for the distance of a flat port where neither
// it nor any length is known, since only their ratio is seen.
void set_free_numbers(const std::string& refine, const Sigmas& sigmas,
                      const axial::pose::Bundle& bundle, axial::pose::AdjustOptions& adjust);
