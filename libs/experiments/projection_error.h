// SPDX-License-Identifier: GPL-3.0-or-later
// Round trips through the port, as in the paper's figure 2: a position in the image is
// back-projected to a point in the water, and this point is projected forward again.
#pragma once

#include "experiments/distribution.h"
#include "experiments/setup.h"

namespace axial::experiments {

// Errors [px] of one method. `missed`: the number of visible points that the method reports as
// invisible.
struct RoundTrips {
  Distribution errors;
  std::int64_t missed = 0;
};

struct ProjectionErrors {
  RoundTrips line_search;  // Algorithm 1, in double, so that float rounding adds no error
  RoundTrips exact;        // the exact projection, with a fixed number of steps, in float
};

// Returns the errors of the round trips. The positions are `step` pixels apart and fill the area of
// a size x size image. The point of a position lies on its ray, at a random distance of 0.5 to 10 m
// (log-uniform). The random number depends only on the index of the position.
ProjectionErrors projection_errors(const CameraSetup& setup, int size, double step);

}  // namespace axial::experiments
