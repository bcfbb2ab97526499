// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of many distances.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace axial::evaluate {

inline constexpr std::array<double, 5> kPercentiles{50, 75, 90, 95, 99};

// Statistics of unsigned distances [m]. No outlier is left out. `variance` is the mean squared
// deviation of the unsigned distances from their mean, so rms^2 = mean^2 + variance.
struct DistanceStatistics {
  std::size_t count = 0;
  double mean = 0, median = 0, rms = 0, variance = 0, max = 0;
  std::array<double, kPercentiles.size()> percentiles{};  // at kPercentiles
};

// All values are zero if there are no distances.
DistanceStatistics summarise(std::span<const float> distances);

// The p-th percentile (0 to 100) of sorted values, interpolated linearly; 0 if there are no values.
double percentile_of_sorted(std::span<const float> sorted, double p);

// The median; 0 if there are no values.
double median_of(std::vector<float> values);

// Counts in bins of equal width over [0, upper). `beyond` counts the values at or above `upper`.
struct Histogram {
  double upper = 0;
  std::vector<std::size_t> counts;
  std::size_t beyond = 0;
};

Histogram histogram(std::span<const float> distances, double upper, std::size_t bins);

// Precision is the share of the reconstruction that is within the tolerance of the truth. Recall is
// the share of the truth that is within the tolerance of the reconstruction. The F-score is their
// harmonic mean. A distance equal to the tolerance is within the tolerance. If there are no
// distances, the share is 0.
struct Score {
  double tolerance = 0;
  double precision = 0, recall = 0, f_score = 0;
};

// Computes the scores. `to_truth`: distances from the reconstruction to the truth [m].
// `to_reconstruction`: distances from the truth to the reconstruction [m].
Score score(std::span<const float> to_truth, std::span<const float> to_reconstruction,
            double tolerance);

// Computes the F-score from the two shares.
Score score_of(double tolerance, double precision, double recall);

}  // namespace axial::evaluate
