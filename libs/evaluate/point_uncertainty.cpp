// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/point_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "evaluate/statistics.h"

namespace axial::evaluate {
namespace {

constexpr std::size_t kConfidenceClasses = 10;
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 3> kClassesOfViews{
    {{0, 2}, {3, 3}, {4, 0}}};

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::vector<double> shares_within(std::span<const float> distances,
                                  std::span<const double> tolerances) {
  std::vector<double> within;
  for (const double tolerance : tolerances)
    within.push_back(score(distances, {}, tolerance).precision);
  return within;
}

// The values of the points that were fused from `least` to `most` depth maps; most 0: `least` or
// more.
std::vector<float> of_views(std::span<const float> values, std::span<const std::uint32_t> views,
                            std::uint32_t least, std::uint32_t most) {
  std::vector<float> chosen;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (views[i] >= least && (most == 0 || views[i] <= most)) chosen.push_back(values[i]);
  return chosen;
}

NormalisedErrors summary_of(std::vector<float> normalised) {
  std::erase_if(normalised, [](float value) { return std::isnan(value); });
  const DistanceStatistics statistics = summarise(normalised);
  NormalisedErrors errors{normalised.size(), statistics.rms, statistics.median, {}};
  for (std::size_t k = 0; k < errors.within.size(); ++k)
    errors.within[k] = score(normalised, {}, static_cast<double>(k + 1)).precision;
  return errors;
}

// The distances of points divided by their expected errors; NaN where no error is expected.
std::vector<float> normalised(const PointUncertainty& uncertainty,
                              std::span<const float> distances) {
  std::vector<float> result(distances.size(), NAN);
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (uncertainty.error[i] > 0 && std::isfinite(uncertainty.error[i]))
      result[i] = distances[i] / uncertainty.error[i];
  return result;
}

std::vector<Reliability> reliability_of(std::span<const float> confidence,
                                        std::span<const float> normalised) {
  std::vector<Reliability> classes(kConfidenceClasses);
  std::vector<std::size_t> within(kConfidenceClasses, 0);
  for (std::size_t i = 0; i < normalised.size(); ++i) {
    if (!(confidence[i] >= 0 && confidence[i] <= 1))
      fail("point {} has confidence {}: must be 0 to 1", i, confidence[i]);
    if (std::isnan(normalised[i])) continue;
    const auto k = std::min(kConfidenceClasses - 1,
                            static_cast<std::size_t>(confidence[i] * float{kConfidenceClasses}));
    ++classes[k].points;
    classes[k].mean_confidence += static_cast<double>(confidence[i]);
    if (normalised[i] <= float{kReliableErrors}) ++within[k];
  }
  for (std::size_t k = 0; k < kConfidenceClasses; ++k) {
    Reliability& one = classes[k];
    one.begin = static_cast<double>(k) / kConfidenceClasses;
    one.end = static_cast<double>(k + 1) / kConfidenceClasses;
    one.within = share(within[k], one.points);
    if (one.points > 0) one.mean_confidence /= static_cast<double>(one.points);
  }
  return classes;
}

}  // namespace

std::vector<ErrorsOfViews> errors_by_views(std::span<const std::uint32_t> views,
                                           std::span<const float> distances,
                                           std::span<const double> tolerances, double gross) {
  std::vector<ErrorsOfViews> classes;
  for (const auto& [least, most] : kClassesOfViews) {
    const std::vector<float> of_class = of_views(distances, views, least, most);
    const DistanceStatistics errors = summarise(of_class);
    const auto beyond = static_cast<std::size_t>(std::ranges::count_if(
        of_class, [&](float distance) { return static_cast<double>(distance) > gross; }));
    classes.push_back({least, most, errors.count, share(errors.count, distances.size()),
                       errors.mean, errors.median, share(beyond, errors.count),
                       shares_within(of_class, tolerances)});
  }
  return classes;
}

std::optional<Calibration> calibration_of(const PointUncertainty& uncertainty,
                                          std::span<const float> distances) {
  if (uncertainty.error.empty()) return {};
  const std::vector<float> all = normalised(uncertainty, distances);
  Calibration result{summary_of(all), {}, {}};
  if (!uncertainty.views.empty())
    for (const auto& [least, most] : kClassesOfViews)
      result.by_views.push_back(
          {least, most, summary_of(of_views(all, uncertainty.views, least, most))});
  if (!uncertainty.confidence.empty())
    result.reliability = reliability_of(uncertainty.confidence, all);
  return result;
}

}  // namespace axial::evaluate
