// SPDX-License-Identifier: GPL-3.0-or-later
// Time and error of one forward projection, by each method: one thread, float without SIMD, one
// translation unit.
#pragma once

#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

// The order in which the points are projected. kScattered: each point is at a random place in the
// image. kReading: runs of 100 points in a row of the image, one pixel apart. Each run begins at a
// random place. The order matters because a search in a table waits for memory if the points are
// scattered.
enum class Order { kScattered, kReading };

// Precondition of time_projections(): all numbers are at least 1, and `repetitions` is odd.
struct TimingOptions {
  int points = 20000;          // points per repetition, for all methods but "analytic"
  int analytic_points = 1000;  // points per repetition for "analytic"; at most `points`
  int repetitions = 9;         // each repetition runs all methods in turn
};

// Time and error of one method.
struct MethodTime {
  // One of:
  // - "exact": the exact projection (FlatPortCamera)
  // - "line_search_compact": the paper's Algorithm 1 (refractive::LineSearchCamera)
  // - "line_search_plain", "line_search_tight": Algorithm 1 with PlainCell, with TightCell
  //   (table_search.h)
  // - "analytic": a root of a polynomial (refractive/polynomial_projection.h)
  std::string method;
  double nanoseconds = 0;  // CPU time of a projection, median over the repetitions
  double ratio = 0;        // time / time of "exact" in the same repetition, median of these ratios
  // Mean distance between the projections and the true images [px], over the points that are not
  // missed.
  double mean_error = 0;
  // The number of projected points of a repetition, and the number of them that the method reports
  // as invisible. The camera sees all points.
  int points = 0, missed = 0;
};

// Times all methods on the same options.points random points. "analytic" projects only the first
// options.analytic_points of these points. Each point lies on the ray in water of a position in an
// image of width x height pixels, 1 to 5 m from the ray's origin. The position is the true image of
// the point. Returns the methods in the order "exact", "line_search_plain", "line_search_compact",
// "line_search_tight", "analytic".
std::vector<MethodTime> time_projections(const CameraSetup& setup, int width, int height,
                                         Order order, const TimingOptions& options);

}  // namespace axial::experiments
