// SPDX-License-Identifier: GPL-3.0-or-later
// Round trips through the port, as in the paper's figure 2: a position in the image is projected
// back to a point in the water, and that point forward again.
#pragma once

#include "experiments/distribution.h"
#include "experiments/setup.h"

namespace axial::experiments {

// Errors in pixels. `missed`: points that the method calls invisible, although they are not.
struct RoundTrips {
  Distribution errors;
  std::int64_t missed = 0;
};

struct ProjectionErrors {
  RoundTrips line_search;  // Algorithm 1, in double: its error is no matter of rounding
  RoundTrips exact;        // the fixed steps, in float
};

// Positions `step` pixels apart that fill the area of a size x size image. The point of each lies
// 0.5 to 10 m along its ray, log-uniform, drawn by the position's number.
ProjectionErrors projection_errors(const CameraSetup& setup, int size, double step);

}  // namespace axial::experiments
