// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of many distances.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace axial::evaluate {

// The percentiles of DistanceStatistics [%].
inline constexpr std::array<double, 5> kPercentiles{50, 75, 90, 95, 99};

// Statistics of unsigned distances [m]. No outlier is left out. `variance` [m^2] is the mean
// squared deviation of the unsigned distances from their mean, so rms^2 = mean^2 + variance.
struct DistanceStatistics {
  std::size_t count = 0;
  double mean = 0, median = 0, rms = 0, variance = 0, max = 0;
  std::array<double, kPercentiles.size()> percentiles{};  // at kPercentiles
};

// Returns the statistics of `distances` [m], in any order. All numbers are 0 if there are no
// distances. Precondition: no distance is NaN.
DistanceStatistics summarise(std::span<const float> distances);

// Numbers of values in bins of equal width over [0, upper). The unit of `upper` is that of the
// values.
struct Histogram {
  double upper = 0;
  std::vector<std::size_t> counts;  // one count for each bin, in ascending order
  std::size_t beyond = 0;           // number of values at or above `upper`
};

// Returns the histogram with `bins` bins over [0, upper). Precondition: `upper` is positive, and no
// distance is negative.
Histogram histogram(std::span<const float> distances, double upper, std::size_t bins);

// Precision is the share of the reconstruction that is within the tolerance of the truth. Recall is
// the share of the truth that is within the tolerance of the reconstruction. The F-score is the
// harmonic mean of precision and recall; 0 if both are 0. A distance equal to the tolerance is
// within the tolerance.
struct Score {
  double tolerance = 0;  // [m]
  double precision = 0, recall = 0, f_score = 0;
};

// Computes the score for `tolerance` [m]. `to_truth`: distances from the reconstruction to the
// truth [m], for precision. `to_reconstruction`: distances from the truth to the reconstruction
// [m], for recall. A share of no distances is 0.
Score score(std::span<const float> to_truth, std::span<const float> to_reconstruction,
            double tolerance);

// Returns the score with these numbers, and computes its F-score.
Score score_of(double tolerance, double precision, double recall);

}  // namespace axial::evaluate
