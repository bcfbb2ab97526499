// SPDX-License-Identifier: GPL-3.0-or-later
// Forward projections by each method at 2 to 10 megapixels, with their times and errors.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "experiments/projection_time.h"

namespace axial::benchmarks {
namespace {

using experiments::MethodTime;

// All methods of one size are measured together, in turn.
const std::vector<MethodTime>& measured(int megapixels) {
  static std::map<int, std::vector<MethodTime>> all;
  std::vector<MethodTime>& times = all[megapixels];
  const auto height = static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 * 3 / 4)));
  if (times.empty())
    times = experiments::time_projections({}, height * 4 / 3, height,
                                          experiments::Order::kScattered, {});
  return times;
}

void project(benchmark::State& state, int megapixels, std::size_t method) {
  const MethodTime& time = measured(megapixels).at(method);
  for ([[maybe_unused]] auto unused : state) state.SetIterationTime(1e-9 * time.nanoseconds);
  state.SetLabel(time.method);
  state.counters["of_exact"] = time.ratio;
  state.counters["mean_error_px"] = time.mean_error;
  state.counters["missed"] = time.missed;
}

}  // namespace
}  // namespace axial::benchmarks

int main(int argc, char** argv) {
  const char* methods[] = {"exact", "line_search_plain", "line_search_compact", "line_search_tight",
                           "analytic"};
  for (const int megapixels : {2, 4, 6, 8, 10})
    for (std::size_t m = 0; m < std::size(methods); ++m)
      benchmark::RegisterBenchmark(
          ("projection/" + std::to_string(megapixels) + "MP/" + methods[m]).c_str(),
          [=](benchmark::State& state) { axial::benchmarks::project(state, megapixels, m); })
          ->UseManualTime()
          ->Iterations(1)
          ->Unit(benchmark::kNanosecond);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
