// SPDX-License-Identifier: GPL-3.0-or-later
// Time and error of one forward projection, by each method: one thread, float without SIMD, one
// translation unit.
#pragma once

#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

// The order of the projected points. A search in a table waits for memory if the points are
// scattered over the image.
enum class Order { kScattered, kReading };

struct TimingOptions {
  int points = 20000;          // projected in one repetition; the analytic solver gets fewer
  int analytic_points = 1000;  // at most `points`
  int repetitions = 9;         // of all methods, in turn
};

struct MethodTime {
  std::string method;      // "exact", "line_search_plain", "_compact", "_tight", "analytic"
  double nanoseconds = 0;  // per projection: median of the thread's CPU time over the repetitions
  double ratio = 0;        // of the time to that of "exact": median over the repetitions
  double mean_error = 0;   // [px]
  int points = 0, missed = 0;
};

// Times all methods on the same points, 1 to 5 m away, in images of width x height pixels.
std::vector<MethodTime> time_projections(const CameraSetup& setup, int width, int height,
                                         Order order, const TimingOptions& options);

}  // namespace axial::experiments
