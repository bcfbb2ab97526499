// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/exposure.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::color {
namespace {

constexpr std::size_t kLeastObservations = 30;

// Logarithms of exposures of one channel, by view: medians of `ratios`, with the mean 0.
std::vector<float> centred_medians(std::vector<std::vector<float>> ratios) {
  std::vector<float> medians;
  float sum = 0, count = 0;
  for (std::vector<float>& of_view : ratios) {
    const bool known = of_view.size() >= kLeastObservations;
    medians.push_back(known ? upper_median(std::move(of_view)) : std::nanf(""));
    sum += known ? medians.back() : 0;
    count += known ? 1 : 0;
  }
  for (float& median : medians)
    median = std::isnan(median) ? 0 : median - sum / std::max(count, 1.0f);
  return medians;
}

void set_channel(Exposures& exposures, int k, const std::vector<float>& logarithms) {
  for (std::size_t view = 0; view < exposures.size(); ++view)
    exposures[view][k] = std::exp(logarithms[view]);
}

}  // namespace

Exposures exposures_of(std::span<const double> ratios) {
  double mean = 0;
  for (const double ratio : ratios) mean += std::log(ratio) / static_cast<double>(ratios.size());
  Exposures exposures;
  for (const double ratio : ratios)
    exposures.push_back(Eigen::Array3f::Constant(static_cast<float>(ratio / std::exp(mean))));
  return exposures;
}

Exposures even_exposures(const Observations& observations, std::size_t views) {
  constexpr int kIterations = 20;
  Exposures exposures(views, Eigen::Array3f::Ones());
  for (int k = 0; k < 3; ++k) {
    std::vector<float> logarithms(views, 0);
    for (int i = 0; i < kIterations; ++i) {
      std::vector<std::vector<float>> ratios(views);
      for (std::size_t point = 0; point < observations.points(); ++point) {
        float mean = 0, count = 0;
        for (const Observation& seen : observations.of(point)) {
          if (!(seen.light[k] > 0)) continue;
          mean += std::log(seen.light[k]) - logarithms[seen.view];
          ++count;
        }
        for (const Observation& seen : observations.of(point))
          if (seen.light[k] > 0 && count > 1)
            ratios[seen.view].push_back(std::log(seen.light[k]) - mean / count);
      }
      logarithms = centred_medians(std::move(ratios));
    }
    set_channel(exposures, k, logarithms);
  }
  return exposures;
}

Exposures exposures_by(const WaterModel& model, const Observations& observations,
                       std::size_t views) {
  Exposures exposures(views, Eigen::Array3f::Ones());
  const std::array<bool, 3> known = determined(model);
  for (int k = 0; k < 3; ++k) {
    if (!known[static_cast<std::size_t>(k)]) continue;
    std::vector<std::vector<float>> ratios(views);
    for (std::size_t point = 0; point < observations.points(); ++point) {
      std::vector<float> surfaces;
      float sum = 0;
      for (const Observation& seen : observations.of(point)) {
        surfaces.push_back(surface_light(model, seen.sight, seen.light)[k]);
        sum += surfaces.back();
      }
      if (surfaces.size() < 2 || !std::isfinite(sum)) continue;
      for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Observation& seen = observations.of(point)[i];
        const float others = (sum - surfaces[i]) / static_cast<float>(surfaces.size() - 1);
        const float expected =
            light_of_surface(model, seen.sight, Eigen::Array3f::Constant(others))[k];
        if (expected > 0 && seen.light[k] > 0)
          ratios[seen.view].push_back(std::log(seen.light[k] / expected));
      }
    }
    set_channel(exposures, k, centred_medians(std::move(ratios)));
  }
  return exposures;
}

Evened fit_exposures(const Observations& observations, std::size_t views, const Transfer& transfer,
                     std::optional<Light> light) {
  constexpr int kMost = 8;
  constexpr double kEnough = 0.002;
  Evened evened{{}, Exposures(views, Eigen::Array3f::Ones()), observations};
  Exposures step = even_exposures(observations, views);
  for (int i = 0; i < kMost; ++i) {
    evened.even = divided_by(step, std::move(evened.even));
    for (std::size_t view = 0; view < views; ++view) evened.exposures[view] *= step[view];
    evened.choice = fit_light(evened.even, transfer, light);
    light = evened.choice.light;
    step = exposures_by(evened.choice.model, evened.even, views);
    if (difference_of(step) < kEnough) break;
  }
  return evened;
}

Observations divided_by(const Exposures& exposures, Observations observations) {
  for (Observation& seen : observations.all) {
    seen.light /= exposures[seen.view];
    seen.spread /= exposures[seen.view];
  }
  return observations;
}

double difference_of(const Exposures& exposures) {
  double largest = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> logarithms;
    for (const Eigen::Array3f& exposure : exposures) logarithms.push_back(std::log(exposure[k]));
    largest = std::max(largest, static_cast<double>(robust_deviation(std::move(logarithms))));
  }
  return largest;
}

}  // namespace axial::color
