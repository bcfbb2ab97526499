// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost work: the time of one plane hypothesis in one source view, for every camera and
// instruction set, compared with the limits of the machine.
#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"
#include "benchmarks/cpu_time.h"
#include "benchmarks/instruction_sets.h"
#include "benchmarks/machine_limits.h"
#include "benchmarks/survey.h"

namespace axial::benchmarks {
namespace {

using depth::lanes::InstructionSet;

// Multiplications and additions of floats in lane_zncc.h for one sample of one lane: 1 for the
// mean, 6 for the three sums. Integer operations (positions, bilinear value) are not counted, so
// this limit is much too optimistic.
constexpr double kOperationsPerSample = 7;
constexpr double kSamplesPerScore = depth::kTexels;

// Scores as in a level's first sweep: a pixel's own plane in four views and the planes of two
// neighbours in two views each, then trials in the two best views.
constexpr std::size_t kCandidates = 3, kTrials = 8;
constexpr std::array<depth::ScorePair, 8> kCandidatePairs{
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {1, 4}, {2, 1}, {2, 2}}};
constexpr std::size_t kScoresPerPixel = kCandidatePairs.size() + 2 * kTrials;
constexpr int kChunk = 32;  // pixels between two readings of the clock

struct Question {
  depth::ReferencePixel pixel;
  std::array<depth::PlaneHypothesis, kCandidates> candidates;
  std::array<depth::PlaneHypothesis, kTrials> trials;
  std::array<depth::ScorePair, 2 * kTrials> trial_pairs;
  std::array<depth::SurfacePoint, 4> around;
};

template <class Camera>
Question question(const Survey& survey, const depth::LaneMatcher<Camera>& matcher, int x, int y,
                  std::mt19937& random) {
  Question asked;
  asked.pixel = matcher.pixels().prepare(x, y);
  for (auto& plane : asked.candidates) plane = near_truth(survey, x, y, 0.004f, 0.2f, random);
  for (auto& plane : asked.trials) plane = near_truth(survey, x, y, 0.002f, 0.1f, random);
  for (std::size_t k = 0; k < asked.around.size(); ++k) {
    const depth::PlaneHypothesis& plane = asked.trials[k];
    const Eigen::Vector3f p = asked.pixel.ray.at(plane.depth);
    asked.around[k] = {{p.x(), p.y(), p.z()},
                       {plane.normal.x(), plane.normal.y(), plane.normal.z()}};
  }
  const unsigned best = static_cast<unsigned>(random());
  for (unsigned k = 0; k < asked.trial_pairs.size(); ++k)
    asked.trial_pairs[k] = {static_cast<std::uint8_t>(k / 2),
                            static_cast<std::uint8_t>((best + k % 2) % kSourceViews)};
  return asked;
}

template <class Camera>
void answer(const depth::LaneMatcher<Camera>& matcher, const Question& asked) {
  std::array<depth::PlaneScore, kCandidatePairs.size()> all;
  std::array<depth::PlaneScore, 2 * kTrials> best;
  matcher.score(asked.pixel, asked.candidates, kCandidatePairs, asked.around, all);
  matcher.score(asked.pixel, asked.trials, asked.trial_pairs, asked.around, best);
  benchmark::DoNotOptimize(all);
  benchmark::DoNotOptimize(best);
}

// Walks over the image in reading order, a part of a row in each iteration. All sources see all of
// these pixels.
class Walk {
 public:
  explicit Walk(const Survey& survey)
      : right_(survey.truth.width - 64 - kChunk), bottom_(survey.truth.height - 64) {}

  int x = 64, y = 64;

  void step() {
    x += kChunk;
    if (x < right_) return;
    x = 64;
    if (++y >= bottom_) y = 64;
  }

 private:
  int right_, bottom_;
};

template <class Camera>
void score(benchmark::State& state, bool behind_port, InstructionSet set, bool geometric) {
  const Survey& scene = survey(behind_port);
  const Bench<Camera> bench(scene, geometric, set);
  std::mt19937 random(1);
  Walk walk(scene);
  std::vector<Question> questions(kChunk);
  double seconds = 0;
  for (auto _ : state) {
    for (int i = 0; i < kChunk; ++i)
      questions[static_cast<std::size_t>(i)] =
          question(scene, bench.matcher(), walk.x + i, walk.y, random);
    walk.step();
    const double begin = thread_cpu_seconds();
    for (const Question& asked : questions) answer(bench.matcher(), asked);
    const double spent = thread_cpu_seconds() - begin;
    state.SetIterationTime(spent);
    seconds += spent;
  }
  const double scores = static_cast<double>(state.iterations()) * kChunk * kScoresPerPixel;
  const double samples_per_ns = kSamplesPerScore * scores / (seconds * 1e9);
  const MachineLimits limits = machine_limits(set);
  const double ghz = clock_ghz();
  state.counters["ns_per_score"] = seconds * 1e9 / scores;
  state.counters["GHz"] = ghz;
  state.counters["samples_per_cycle"] = samples_per_ns / ghz;
  state.counters["gather_roof"] = limits.gathered_words_per_ns / ghz;
  state.counters["load_roof"] = limits.loaded_words_per_ns / ghz;
  state.counters["float_roof"] = limits.float_operations_per_ns / kOperationsPerSample / ghz;
  state.counters["of_roof"] =
      samples_per_ns /
      std::min(limits.words_per_ns(), limits.float_operations_per_ns / kOperationsPerSample);
}

template <class Camera>
void add(const std::string& camera, bool behind_port, InstructionSet set, bool geometric) {
  const std::string name =
      "score/" + camera + "/" + name_of(set) + (geometric ? "/geometric" : "/photometric");
  benchmark::RegisterBenchmark(
      name.c_str(),
      [=](benchmark::State& state) { score<Camera>(state, behind_port, set, geometric); })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace

void add_scorer_benchmarks() {
  for (const InstructionSet set : depth::lanes::available_instruction_sets())
    for (const bool geometric : {false, true}) {
      add<refractive::PinholeCamera<float>>("pinhole", false, set, geometric);
      add<refractive::FlatPortCamera<float>>("flat_port", true, set, geometric);
    }
}

}  // namespace axial::benchmarks
