// SPDX-License-Identifier: GPL-3.0-or-later
// Round trips through the port, as in the paper's figure 2: a position in the image is
// back-projected to a point in the water, and this point is projected forward again.
#pragma once

#include "experiments/distribution.h"
#include "experiments/setup.h"

namespace axial::experiments {

// Errors in pixels. `missed`: visible points that the method reports as invisible.
struct RoundTrips {
  Distribution errors;
  std::int64_t missed = 0;
};

struct ProjectionErrors {
  RoundTrips line_search;  // Algorithm 1, in double: its error is not caused by rounding
  RoundTrips exact;        // fixed number of steps, in float
};

// Round trips of positions `step` pixels apart that fill the area of a size x size image. The point
// of each position lies 0.5 to 10 m along its ray, at a log-uniform distance that depends on the
// position's index alone.
ProjectionErrors projection_errors(const CameraSetup& setup, int size, double step);

}  // namespace axial::experiments
