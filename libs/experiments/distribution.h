// SPDX-License-Identifier: GPL-3.0-or-later
// The distribution of very many errors: counts in equal bins, and the exact mean and largest error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace axial::experiments {

class Distribution {
 public:
  // `bins` equal bins over [0, upper).
  Distribution(double upper, std::size_t bins) : upper_(upper), counts_(bins, 0) {}

  void add(double error) {
    ++count_;
    sum_ += error;
    if (error > largest_) largest_ = error;
    const double bin = error / upper_ * static_cast<double>(counts_.size());
    if (bin < static_cast<double>(counts_.size()))
      ++counts_[static_cast<std::size_t>(bin)];
    else
      ++beyond_;
  }

  // Adds all errors of `other`. Precondition: `other` has the same bins.
  void merge(const Distribution& other);

  std::int64_t count() const { return count_; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  double largest() const { return largest_; }
  // Returns the error e such that the share `q` (0 to 1) of all errors is at most e. e is
  // interpolated linearly within its bin. If e lies beyond the bins, the result is largest().
  double quantile(double q) const;

  double upper() const { return upper_; }
  const std::vector<std::int64_t>& counts() const { return counts_; }
  std::int64_t beyond() const { return beyond_; }

 private:
  double upper_;
  std::vector<std::int64_t> counts_;
  std::int64_t beyond_ = 0, count_ = 0;
  double sum_ = 0, largest_ = 0;
};

// The median; for an even number of values, the mean of the two middle values. Precondition: not
// empty.
double median_of(std::vector<double> values);

}  // namespace axial::experiments
