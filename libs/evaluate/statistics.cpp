// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/statistics.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::evaluate {
namespace {

double fraction_within(std::span<const float> distances, double tolerance) {
  if (distances.empty()) return 0;
  const auto limit = static_cast<float>(tolerance);
  const auto within = std::count_if(distances.begin(), distances.end(),
                                    [limit](float distance) { return distance <= limit; });
  return static_cast<double>(within) / static_cast<double>(distances.size());
}

}  // namespace

DistanceStatistics summarise(std::span<const float> distances) {
  DistanceStatistics result;
  result.count = distances.size();
  if (distances.empty()) return result;
  std::vector<float> sorted(distances.begin(), distances.end());
  std::sort(sorted.begin(), sorted.end());
  const auto count = static_cast<double>(sorted.size());
  double sum = 0, squares = 0, spread = 0;
  for (const float value : sorted) {
    const auto d = static_cast<double>(value);
    sum += d;
    squares += d * d;
  }
  result.mean = sum / count;
  for (const float value : sorted) {
    const double off = static_cast<double>(value) - result.mean;
    spread += off * off;
  }
  result.rms = std::sqrt(squares / count);
  result.variance = spread / count;
  result.max = static_cast<double>(sorted.back());
  for (std::size_t k = 0; k < kPercentiles.size(); ++k)
    result.percentiles[k] = interpolated_quantile<float>(sorted, kPercentiles[k] / 100);
  result.median = result.percentiles[0];
  return result;
}

Histogram histogram(std::span<const float> distances, double upper, std::size_t bins) {
  Histogram result{upper, std::vector<std::size_t>(bins), 0};
  for (const float distance : distances) {
    const double at = static_cast<double>(distance) / upper * static_cast<double>(bins);
    if (at < static_cast<double>(bins))
      ++result.counts[static_cast<std::size_t>(std::max(at, 0.0))];
    else
      ++result.beyond;
  }
  return result;
}

Score score_of(double tolerance, double precision, double recall) {
  const double sum = precision + recall;
  return {tolerance, precision, recall, sum > 0 ? 2 * precision * recall / sum : 0.0};
}

Score score(std::span<const float> to_truth, std::span<const float> to_reconstruction,
            double tolerance) {
  return score_of(tolerance, fraction_within(to_truth, tolerance),
                  fraction_within(to_reconstruction, tolerance));
}

}  // namespace axial::evaluate
