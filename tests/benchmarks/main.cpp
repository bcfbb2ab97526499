// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmarks of matching, from one score to whole depth maps. See docs/performance.md.
#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"

int main(int argc, char** argv) {
  axial::benchmarks::add_scorer_benchmarks();
  axial::benchmarks::add_matching_benchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
