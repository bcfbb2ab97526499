// SPDX-License-Identifier: GPL-3.0-or-later
// The distribution of very many errors: counts in equal bins, and the exact mean and largest error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace axial::experiments {

// `upper`, mean(), largest() and quantile() are in the unit of the added errors.
class Distribution {
 public:
  // Makes an empty distribution with `bins` bins of equal width over [0, upper). Larger errors are
  // counted together (beyond()). Precondition: `upper` is positive, and `bins` is at least 1.
  Distribution(double upper, std::size_t bins) : upper_(upper), counts_(bins, 0) {}

  // Precondition: `error` is not negative and not NaN.
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

  // Adds all errors of `other`. Precondition: `other` was made with the same `upper` and `bins`.
  void merge(const Distribution& other);

  std::int64_t count() const { return count_; }  // number of all errors
  // The mean and the largest of all errors are exact. Without errors they are 0.
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  double largest() const { return largest_; }
  // Returns the error e such that the share `q` (0 to 1) of all errors is at most e. e is
  // interpolated linearly within its bin. If e is not less than `upper`, the result is largest().
  // Without errors the result is 0.
  double quantile(double q) const;

  double upper() const { return upper_; }  // as in the constructor
  // The number of errors in each bin, in ascending order of the bins.
  const std::vector<std::int64_t>& counts() const { return counts_; }
  std::int64_t beyond() const { return beyond_; }  // number of errors that are at least `upper`

 private:
  double upper_;
  std::vector<std::int64_t> counts_;
  std::int64_t beyond_ = 0, count_ = 0;
  double sum_ = 0, largest_ = 0;
};

}  // namespace axial::experiments
