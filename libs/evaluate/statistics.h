// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that sum up many distances.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace axial::evaluate {

inline constexpr std::array<double, 5> kPercentiles{50, 75, 90, 95, 99};

// Of unsigned distances [m], every one of them: no outlier is cut. `variance` is that of the
// unsigned distances around their mean (divided by their number), so rms^2 = mean^2 + variance.
struct DistanceStatistics {
  std::size_t count = 0;
  double mean = 0, median = 0, rms = 0, variance = 0, max = 0;
  std::array<double, kPercentiles.size()> percentiles{};  // at kPercentiles
};

// All zero for no distances.
DistanceStatistics summarise(std::span<const float> distances);

// The p-th percentile (0 to 100) of sorted values, linear between neighbours; 0 if there are none.
double percentile_of_sorted(std::span<const float> sorted, double p);

// 0 for none.
double median_of(std::vector<float> values);

// Counts in bins of equal width over [0, upper), and what lies at or beyond `upper`.
struct Histogram {
  double upper = 0;
  std::vector<std::size_t> counts;
  std::size_t beyond = 0;
};

Histogram histogram(std::span<const float> distances, double upper, std::size_t bins);

// How much of what was reconstructed is right (precision), how much of what could be seen was
// found (recall), and their harmonic mean. Both sides count a distance equal to the tolerance as
// within it. 0 where there is nothing to count.
struct Score {
  double tolerance = 0;
  double precision = 0, recall = 0, f_score = 0;
};

// `to_truth`: distances of the reconstruction to the truth; `to_reconstruction`: the other way.
Score score(std::span<const float> to_truth, std::span<const float> to_reconstruction,
            double tolerance);

// From the two fractions.
Score score_of(double tolerance, double precision, double recall);

}  // namespace axial::evaluate
