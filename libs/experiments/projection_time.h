// SPDX-License-Identifier: GPL-3.0-or-later
// What one forward projection costs, and errs, by each method: one thread, plain floats, one
// translation unit.
#pragma once

#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

// How the projected points follow each other. A search that asks a table waits for memory if they
// are scattered over the image.
enum class Order { kScattered, kReading };

struct TimingOptions {
  int points = 20000;          // projected in one go; the analytic solver gets fewer
  int analytic_points = 1000;  // at most `points`
  int repetitions = 9;         // of all methods in turn
};

struct MethodTime {
  std::string method;      // "exact", "line_search_plain", "_compact", "_tight", "analytic"
  double nanoseconds = 0;  // per projection: median over the repetitions, of the thread's CPU time
  double ratio = 0;        // to "exact": median of the repetitions' own ratios
  double mean_error = 0;   // [px]
  int points = 0, missed = 0;
};

std::vector<MethodTime> time_projections(const CameraSetup& setup, int width, int height,
                                         Order order, const TimingOptions& options);

}  // namespace axial::experiments
