// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/camera_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace axial::color {
namespace {

// A part of the points, which is enough for a spread. A part is its own part.
Observations part_of(const Observations& observations) {
  constexpr std::size_t kPoints = 500;
  return every(std::max<std::size_t>(1, observations.points() / kPoints), 0, observations);
}

// The observations with the light that their values have by another curve.
Observations by_curve(Observations observations, const Transfer& from, const Transfer& to) {
  for (Observation& seen : observations.all)
    for (int k = 0; k < 3; ++k) {
      const float value = from.value(seen.light[k]);
      seen.light[k] = to.light(value);
      seen.spread[k] *= to.slope(value) / from.slope(value);
    }
  return observations;
}

// Tries powers of the curve.
class Search {
 public:
  Search(const Exposures& exposures, const Observations& observations, const Transfer& from,
         Light light)
      : exposures_(exposures), observations_(observations), from_(from), light_(light) {}

  double spread(double gamma) const {
    const Transfer transfer = Transfer::of_gamma(gamma);
    return spread_with(exposures_, by_curve(observations_, from_, transfer), transfer, light_);
  }

  // The best of the powers from 1 to 3, to 0.01, and its spread. The spread has one minimum: it
  // grows with the distance from the right curve.
  std::pair<double, double> best() const {
    constexpr double kFirst = 1, kLast = 3, kStep = 0.4, kLeastStep = 0.02;
    std::pair<double, double> best{kFirst, spread(kFirst)};
    const auto take = [&](double gamma) {
      const double value = spread(gamma);
      if (value < best.second) best = {gamma, value};
    };
    for (int i = 1; kFirst + i * kStep <= kLast; ++i) take(kFirst + i * kStep);
    for (double step = kStep / 2; step > kLeastStep / 2; step /= 2) {
      const double middle = best.first;
      for (const double gamma : {middle - step, middle + step}) take(rounded(gamma));
    }
    return best;
  }

 private:
  static double rounded(double gamma) { return std::round(gamma * 100) / 100; }

  const Exposures& exposures_;
  const Observations& observations_;
  const Transfer& from_;
  Light light_;
};

CameraCurve find_curve_in(Light light, const Exposures& exposures, const Observations& observations,
                          const Transfer& from) {
  constexpr double kNearlyBest = 1.1, kClearlyWorse = 1.15, kOther = 1.2, kGammaOfSrgb = 2.2;
  const Search search(exposures, observations, from, light);
  CameraCurve curve{from};
  curve.spread = curve.spread_first = spread_with(exposures, observations, from, light);
  const auto [gamma, spread] = search.best();
  const bool keeps = curve.spread_first <= kNearlyBest * spread;
  const double middle = keeps ? from.gamma().value_or(kGammaOfSrgb) : gamma;
  const double least = keeps ? curve.spread_first : spread;
  curve.is_told = std::min(search.spread(middle / kOther), search.spread(middle * kOther)) >
                  kClearlyWorse * least;
  if (curve.is_told && !keeps) {
    curve.transfer = Transfer::of_gamma(gamma);
    curve.spread = spread;
  }
  return curve;
}

}  // namespace

double spread_with(const Exposures& exposures, const Observations& observations,
                   const Transfer& transfer, std::optional<Light> light) {
  const Observations even = divided_by(exposures, part_of(observations));
  double least = std::numeric_limits<double>::infinity();
  for (const Light tried : {Light::sun, Light::lamp}) {
    if (light && *light != tried) continue;
    const Choice choice = fit_light(even, transfer, tried);
    least = std::min(least, spread_of(even, &choice.model));
  }
  return least;
}

CameraCurve find_curve(const Exposures& exposures, const Observations& observations,
                       const Transfer& from, std::optional<Light> light) {
  constexpr double kGood = 0.2;
  const Observations part = part_of(observations);
  if (light) return find_curve_in(*light, exposures, part, from);
  const CameraCurve sun = find_curve_in(Light::sun, exposures, part, from);
  if (sun.spread < kGood) return sun;
  const CameraCurve lamp = find_curve_in(Light::lamp, exposures, part, from);
  return lamp.spread < sun.spread ? lamp : sun;
}

}  // namespace axial::color
