// SPDX-License-Identifier: GPL-3.0-or-later
// Round trips through the port, as in the paper's figure 2: a position in the image is
// back-projected to a point in the water, and this point is projected forward again.
#pragma once

#include "experiments/distribution.h"
#include "experiments/setup.h"

namespace axial::experiments {

// Errors of one method of projection. An error is the distance [px] between the position and the
// projection of its point. `missed`: the number of points that the method reports as invisible,
// although the camera sees them. They have no error.
struct RoundTrips {
  Distribution errors;
  std::int64_t missed = 0;
};

// The errors of both methods for the same points.
struct ProjectionErrors {
  RoundTrips line_search;  // Algorithm 1, in double, so that float rounding adds no error
  RoundTrips exact;        // the exact projection, with a fixed number of steps, in float
};

// Returns the errors of the round trips through the port of `setup`. The positions are `step` [px]
// apart in both directions and fill the area of a size x size image, so `step` below 1 gives
// several positions in a pixel. The point of a position lies on its ray in water, at a random
// distance of 0.5 to 10 m from the ray's origin (log-uniform). The random number depends only on
// the index of the position.
ProjectionErrors projection_errors(const CameraSetup& setup, int size, double step);

}  // namespace axial::experiments
