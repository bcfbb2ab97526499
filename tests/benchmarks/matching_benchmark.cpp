// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps and whole depth maps, with pinhole and flat port in turn, strip by strip and map by map.
// Disturbances of the machine then affect both alike: their ratio is the cost of --refractive. One
// thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "benchmarks/benchmarks.h"
#include "benchmarks/cpu_time.h"
#include "benchmarks/instruction_sets.h"
#include "benchmarks/survey.h"
#include "depth/sweep/sweep.h"

namespace axial::benchmarks {
namespace {

struct Cost {
  double seconds = 0;
  double scores = 0;  // each of one hypothesis in one view

  Cost& operator+=(const Cost& b) {
    seconds += b.seconds;
    scores += b.scores;
    return *this;
  }
};

// The start of a level: planes with errors of about one pixel of the coarser level.
depth::PlaneMap coarse_start(const Survey& scene) {
  std::mt19937 random(5);
  depth::PlaneMap map(scene.truth.width, scene.truth.height);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      depth::PlanePixel& pixel = map.at(x, y);
      pixel.plane = near_truth(scene, x, y, 0.01f, 0.3f, random);
      pixel.point =
          scene.truth.at(x, y).point * (pixel.plane.depth / scene.truth.at(x, y).plane.depth);
      pixel.cost = 0.5f;
    }
  return map;
}

depth::SweepInput sweep_input(int number) {
  depth::SweepInput input;
  input.sweep = static_cast<std::uint32_t>(number);
  input.min_depth = 0.5f;
  input.max_depth = 4.0f;
  const depth::PatchMatchOptions options;
  input.first = number == 0;
  input.trial_pairs = input.first ? options.first_pairs : options.later_pairs;
  return input;
}

// Sweeps of one camera at full resolution. Sweeps before `first` are not measured.
template <class Camera>
class SweepRun {
 public:
  SweepRun(bool behind_port, bool geometric, int first, depth::lanes::InstructionSet set)
      : bench_(survey(behind_port), geometric, set),
        matcher_(bench_.matcher()),
        start_(coarse_start(survey(behind_port))) {
    for (int i = 0; i < first; ++i) depth::Sweep(matcher_, start_, options_, sweep_input(i)).run();
  }

  void restart() { map_ = start_; }

  // Begins a sweep and returns its number of strips.
  int begin(int number) {
    sweep_.emplace(matcher_, map_, options_, sweep_input(number));
    sweep_->prepare();
    return sweep_->strips();
  }

  Cost strip(int number) {
    const double before = process_cpu_seconds();
    const std::uint64_t scores = sweep_->run_strip(number);
    benchmark::DoNotOptimize(map_.pixels.data());
    return {process_cpu_seconds() - before, static_cast<double>(scores)};
  }

 private:
  const depth::PatchMatchOptions options_;
  const Bench<Camera> bench_;
  const depth::LaneMatcher<Camera>& matcher_;
  depth::PlaneMap start_, map_;
  std::optional<depth::Sweep<depth::LaneMatcher<Camera>>> sweep_;
};

double pixels() {
  return static_cast<double>(survey(false).truth.pixels.size());
}

void report_ratio(benchmark::State& state, const Cost& pinhole, const Cost& flat_port) {
  state.counters["pinhole_ns"] = pinhole.seconds * 1e9 / pinhole.scores;
  state.counters["flat_port_ns"] = flat_port.seconds * 1e9 / flat_port.scores;
  state.counters["ratio"] =
      (flat_port.seconds / flat_port.scores) / (pinhole.seconds / pinhole.scores);
}

void report_scores(benchmark::State& state, const Cost& pinhole, const Cost& flat_port,
                   double visits) {
  state.counters["pinhole_scores_per_pixel"] = pinhole.scores / visits;
  state.counters["flat_port_scores_per_pixel"] = flat_port.scores / visits;
}

// Nanoseconds per hypothesis and view, with everything that a sweep does in its strips.
void sweep_pair(benchmark::State& state, bool geometric, int first, int last,
                depth::lanes::InstructionSet set) {
  const ThreadLimit one(1);
  SweepRun<refractive::PinholeCamera<float>> dry(false, geometric, first, set);
  SweepRun<refractive::FlatPortCamera<float>> wet(true, geometric, first, set);
  Cost pinhole, flat_port;
  for (auto _ : state) {
    dry.restart(), wet.restart();
    for (int i = first; i <= last; ++i) {
      dry.begin(i);
      const int strips = wet.begin(i);
      for (int strip = 0; strip < strips; ++strip) {
        pinhole += dry.strip(strip);
        flat_port += wet.strip(strip);
      }
    }
  }
  report_ratio(state, pinhole, flat_port);
  const double sweeps = (last - first + 1) * static_cast<double>(state.iterations());
  report_scores(state, pinhole, flat_port, pixels() * sweeps);
}

// Quality is measured with the time, because a faster matcher must not be worse.
struct Quality {
  double median_error = 0;  // relative
  double complete = 0;      // share of the pixels
};

Quality quality(const DepthMap& map, const depth::PlaneMap& truth) {
  std::vector<double> errors;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (map.depth(y, x) > 0)
        errors.push_back(std::abs(map.depth(y, x) / truth.at(x, y).plane.depth - 1));
  if (errors.empty()) return {1, 0};
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return {*middle, static_cast<double>(errors.size()) / static_cast<double>(truth.pixels.size())};
}

// The matching stage of one view with the program's defaults.
DepthMap matched(const Survey& scene, std::uint64_t& scores) {
  constexpr int kGeometricPasses = 2;
  const depth::PatchMatchOptions options;
  depth::MatchInput input = scene.input();
  input.scores = &scores;
  DepthMap map = depth::estimate_depth_map(input, options);
  for (int pass = 0; pass < kGeometricPasses; ++pass)
    map = depth::refine_depth_map(input, map, scene.source_maps, pass, pass + 1 == kGeometricPasses,
                                  options);
  return map;
}

Cost match(bool behind_port, Quality& result) {
  const Survey& scene = survey(behind_port);
  const double begin = process_cpu_seconds();
  std::uint64_t scores = 0;
  const DepthMap map = matched(scene, scores);
  const double end = process_cpu_seconds();
  result = quality(map, scene.truth);
  return {end - begin, static_cast<double>(scores)};
}

// CPU time of whole depth maps; nanoseconds per hypothesis and view include all work.
void depth_map_pair(benchmark::State& state) {
  const ThreadLimit one(1);
  survey(false), survey(true);
  Cost pinhole, flat_port;
  Quality in_air, in_water;
  for (auto _ : state) {
    pinhole += match(false, in_air);
    flat_port += match(true, in_water);
  }
  report_ratio(state, pinhole, flat_port);
  report_scores(state, pinhole, flat_port, pixels() * static_cast<double>(state.iterations()));
  const double megapixels = 1e-6 * pixels() * static_cast<double>(state.iterations());
  state.counters["pinhole_s_per_Mpx"] = pinhole.seconds / megapixels;
  state.counters["flat_port_s_per_Mpx"] = flat_port.seconds / megapixels;
  state.counters["pinhole_error_ppm"] = 1e6 * in_air.median_error;
  state.counters["flat_port_error_ppm"] = 1e6 * in_water.median_error;
  state.counters["pinhole_complete"] = in_air.complete;
  state.counters["flat_port_complete"] = in_water.complete;
}

void add_sweep(const std::string& name, bool geometric, int first, int last) {
  using depth::lanes::InstructionSet;
  for (const InstructionSet set : depth::lanes::available_instruction_sets())
    if (set >= InstructionSet::avx2 || set == depth::lanes::fastest_instruction_set())
      benchmark::RegisterBenchmark(
          (name + "/" + name_of(set)).c_str(),
          [=](benchmark::State& state) { sweep_pair(state, geometric, first, last, set); })
          ->Unit(benchmark::kMillisecond);
}

}  // namespace

void add_matching_benchmarks() {
  // The instruction set that programs use on this machine, also for whole depth maps.
  benchmark::AddCustomContext("instruction_set", name_of(depth::lanes::fastest_instruction_set()));
  add_sweep("sweep/photometric/first", false, 0, 0);
  add_sweep("sweep/photometric/later", false, 1, 2);
  add_sweep("sweep/geometric", true, 3, 3);
  benchmark::RegisterBenchmark("depth_map", depth_map_pair)->Unit(benchmark::kMillisecond);
}

}  // namespace axial::benchmarks
