// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/projection_time.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <span>

#include "base/hash.h"
#include "base/order_statistics.h"
#include "experiments/table_search.h"
#include "refractive/polynomial_projection.h"

namespace axial::experiments {
namespace {

struct Sample {
  Vector3<float> point;
  Vector2<double> pixel;  // the image of `point`
};

// CPU time of this thread: the time of other programs does not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Keeps the optimiser from removing or combining projections.
void keep(const refractive::Projection<float>& projection) {
  asm volatile("" : : "g"(&projection) : "memory");
}

struct TimedMethod {
  std::string name;
  std::size_t points;
  // Seconds for the first `points` samples.
  std::function<double(std::span<const Sample>)> run;
  std::function<refractive::Projection<float>(const Vector3<float>&)> project;
};

template <class Project>
TimedMethod make_method(const std::string& name, std::size_t points, Project project) {
  const auto run = [project](std::span<const Sample> samples) {
    const double begin = thread_seconds();
    for (const Sample& sample : samples) keep(project(sample.point));
    return thread_seconds() - begin;
  };
  return {name, points, run, project};
}

template <class Camera>
TimedMethod camera_method(const std::string& name, std::size_t points, Camera camera) {
  const auto shared = std::make_shared<const Camera>(std::move(camera));
  return make_method(name, points,
                     [shared](const Vector3<float>& X) { return shared->project(X); });
}

std::vector<TimedMethod> make_methods(const CameraSetup& setup, int width, int height,
                                      const TimingOptions& options) {
  const PinholeLens<float> lens = make_lens(setup, width, height).cast<float>();
  const FlatPort<float> port = make_port(setup).cast<float>();
  const FlatPortCamera<float> exact(lens, port, width, height);
  const auto points = static_cast<std::size_t>(options.points);
  const auto analytic_points = static_cast<std::size_t>(options.analytic_points);
  std::vector<TimedMethod> methods;
  methods.push_back(camera_method("exact", points, exact));
  methods.push_back(camera_method("line_search_plain", points,
                                  TableSearch<float, PlainCell<float>>(exact, width, height)));
  methods.push_back(camera_method("line_search_compact", points,
                                  refractive::LineSearchCamera<float>(lens, port, width, height)));
  methods.push_back(camera_method("line_search_tight", points,
                                  TableSearch<float, TightCell<float>>(exact, width, height)));
  methods.push_back(make_method("analytic", analytic_points, [exact](const Vector3<float>& X) {
    return refractive::project_by_polynomial(exact, X);
  }));
  return methods;
}

// Pixels anywhere in the image, or runs of a hundred neighbours in a row that start anywhere. Their
// points are 1 to 5 m away.
std::vector<Sample> make_samples(const CameraSetup& setup, int width, int height, Order order,
                                 int count) {
  const FlatPortCamera<double> camera(make_lens(setup, width, height), make_port(setup), width,
                                      height);
  constexpr std::uint64_t kRun = 100;
  const auto drawn = [](std::uint64_t number) {
    return static_cast<double>(unit_float(scramble(number)));
  };
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(count); ++k) {
    const std::uint64_t place = order == Order::kReading ? k / kRun : k;
    const double along = order == Order::kReading ? static_cast<double>(k % kRun) : 0;
    const double u = std::fmod(drawn(3 * place) * width + along, width) - 0.5;
    const double v = drawn(3 * place + 1) * height - 0.5;
    const double range = 1 + 4 * drawn(3 * place + 2);
    samples.push_back({camera.ray({u, v}).at(range).cast<float>(), {u, v}});
  }
  return samples;
}

void measure_errors(const TimedMethod& method, std::span<const Sample> samples,
                    MethodTime& result) {
  double sum = 0;
  for (const Sample& sample : samples) {
    const refractive::Projection<float> image = method.project(sample.point);
    if (image.visible)
      sum += (image.pixel.cast<double>() - sample.pixel).norm();
    else
      ++result.missed;
  }
  result.points = static_cast<int>(samples.size());
  result.mean_error = sum / std::max(1, result.points - result.missed);
}

}  // namespace

std::vector<MethodTime> time_projections(const CameraSetup& setup, int width, int height,
                                         Order order, const TimingOptions& options) {
  const std::vector<TimedMethod> methods = make_methods(setup, width, height, options);
  const std::vector<Sample> samples = make_samples(setup, width, height, order, options.points);
  const auto own = [&](const TimedMethod& method) {
    return std::span(samples).first(std::min(method.points, samples.size()));
  };
  // All methods in turn, so that a slower phase of the machine affects all methods alike.
  std::vector<std::vector<double>> times(methods.size()), ratios(methods.size());
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const auto chosen = own(methods[m]);
      times[m].push_back(methods[m].run(chosen) / static_cast<double>(chosen.size()));
      ratios[m].push_back(times[m].back() / times[0].back());
    }
  }
  std::vector<MethodTime> results(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    results[m].method = methods[m].name;
    results[m].nanoseconds = 1e9 * upper_median(times[m]);
    results[m].ratio = upper_median(ratios[m]);
    measure_errors(methods[m], own(methods[m]), results[m]);
  }
  return results;
}

}  // namespace axial::experiments
