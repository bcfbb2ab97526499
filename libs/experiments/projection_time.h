// SPDX-License-Identifier: GPL-3.0-or-later
// Time and error of one forward projection, by each method: one thread, float without SIMD, one
// translation unit.
#pragma once

#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

// The order of the projected points. kScattered: each point anywhere in the image. kReading: runs
// of 100 neighbouring pixels of a row. The order matters because a search in a table waits for
// memory if the points are scattered.
enum class Order { kScattered, kReading };

struct TimingOptions {
  int points = 20000;          // points per repetition, for all methods but "analytic"
  int analytic_points = 1000;  // points per repetition for "analytic"; at most `points`
  int repetitions = 9;         // each repetition runs all methods in turn
};

struct MethodTime {
  // "exact", "line_search_plain", "line_search_compact", "line_search_tight" or "analytic".
  std::string method;
  double nanoseconds = 0;  // CPU time of a projection, median over the repetitions
  double ratio = 0;        // time / time of "exact" in the same repetition, median of these ratios
  double mean_error = 0;   // [px]
  int points = 0, missed = 0;
};

// Times all methods on the same points, 1 to 5 m away, in images of width x height pixels.
std::vector<MethodTime> time_projections(const CameraSetup& setup, int width, int height,
                                         Order order, const TimingOptions& options);

}  // namespace axial::experiments
