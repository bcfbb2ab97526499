// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "experiments/projection_error.h"
#include "experiments/projection_time.h"
#include "experiments/table_search.h"

namespace axial::experiments {
namespace {

// Positions 2.3 px apart cover all tenths of a pixel.
ProjectionErrors quick_errors(const CameraSetup& setup) {
  return projection_errors(setup, 1000, 2.3);
}

TEST(ProjectionErrors, AreThePapersAndOurs) {
  for (const CameraSetup& setup : {CameraSetup{.fov_degrees = 50}, CameraSetup{.fov_degrees = 120},
                                   CameraSetup{.distance = 0.1}, CameraSetup{.tilt_degrees = 20}}) {
    const ProjectionErrors errors = quick_errors(setup);
    // The paper: "A mean of roughly a quarter pixel."
    EXPECT_GT(errors.line_search.errors.mean(), 0.24);
    EXPECT_LT(errors.line_search.errors.mean(), 0.29);
    EXPECT_LT(errors.exact.errors.largest(), 1e-3);
    EXPECT_GT(errors.exact.errors.largest(), 1e-7);  // errors of float
    EXPECT_EQ(errors.exact.missed, 0);
    const std::int64_t positions = 434 * 434;  // floor(1000 / 2.3)
    EXPECT_EQ(errors.exact.errors.count(), positions);
    EXPECT_EQ(errors.line_search.errors.count() + errors.line_search.missed, positions);
    EXPECT_LT(errors.line_search.missed, positions / 500);
  }
}

// Without refraction the exact projection is the pinhole's. Algorithm 1 starts at the solution, but
// represents it by rounded pixels, which leaves an error of its own.
TEST(ProjectionErrors, OfAPinholeAreRounding) {
  const ProjectionErrors errors = quick_errors({.n_glass = 1, .n_water = 1});
  EXPECT_LT(errors.exact.errors.largest(), 5e-4);
  EXPECT_GT(errors.line_search.errors.mean(), 0.05);
}

TEST(ProjectionErrors, AreTheSameForAnyNumberOfThreads) {
  const auto with_threads = [](unsigned threads) {
    const ThreadLimit limit(threads);
    return projection_errors({}, 200, 0.7);
  };
  const ProjectionErrors one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.line_search.errors.mean(), four.line_search.errors.mean());
  EXPECT_EQ(one.line_search.errors.counts(), four.line_search.errors.counts());
  EXPECT_EQ(one.exact.errors.mean(), four.exact.errors.mean());
  EXPECT_EQ(one.exact.errors.counts(), four.exact.errors.counts());
}

// The other tables hold the same rays: the search ends at the same place, except where a comparison
// depends on the last bit.
template <class Cell>
void expect_same_search(const CameraSetup& setup) {
  const int width = 320, height = 240;
  const refractive::LineSearchCamera<double> library(make_lens(setup, width, height),
                                                     make_port(setup), width, height);
  const TableSearch<double, Cell> search(library.exact(), width, height);
  int same = 0, all = 0;
  // Never at a pixel's centre, where alpha and beta are equal up to rounding.
  for (double v = -0.35; v < height - 0.6; v += 3.7) {
    for (double u = -0.35; u < width - 0.6; u += 3.3) {
      const Vector3<double> X = library.ray({u, v}).at(1 + 0.01 * u);
      const auto expected = library.project(X);
      const auto found = search.project(X);
      ++all;
      same += found.visible == expected.visible &&
              (!found.visible || (found.pixel - expected.pixel).norm() < 1e-9);
    }
  }
  EXPECT_GT(all, 5000);
  EXPECT_GE(same, all - all / 1000);
}

TEST(TableSearch, IsAlgorithmOneWhateverTheTable) {
  for (const double tilt : {0, 8}) {
    expect_same_search<PlainCell<double>>({.tilt_degrees = tilt});
    expect_same_search<TightCell<double>>({.tilt_degrees = tilt});
  }
}

TEST(ProjectionTimes, StandBesideErrors) {
  for (const Order order : {Order::kScattered, Order::kReading}) {
    const auto times = time_projections({}, 320, 240, order, {2000, 50, 3});
    ASSERT_EQ(times.size(), 5u);
    for (const MethodTime& time : times) {
      EXPECT_EQ(time.points, time.method == "analytic" ? 50 : 2000);
      EXPECT_LT(time.missed, time.points / 50);
      const bool searches = time.method.starts_with("line_search");
      EXPECT_GT(time.mean_error, searches ? 0.2 : 0) << time.method;
      EXPECT_LT(time.mean_error, searches ? 0.32 : 0.05) << time.method;
    }
    EXPECT_EQ(times[0].method, "exact");
    EXPECT_EQ(times[0].ratio, 1);
    EXPECT_LT(times[0].mean_error, 1e-3);
  }
}

}  // namespace
}  // namespace axial::experiments
