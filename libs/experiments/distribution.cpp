// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/distribution.h"

#include <algorithm>

namespace axial::experiments {

void Distribution::merge(const Distribution& other) {
  for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += other.counts_[k];
  beyond_ += other.beyond_;
  count_ += other.count_;
  sum_ += other.sum_;
  largest_ = std::max(largest_, other.largest_);
}

double Distribution::quantile(double q) const {
  const double wanted = q * static_cast<double>(count_);
  const double width = upper_ / static_cast<double>(counts_.size());
  double below = 0;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const auto here = static_cast<double>(counts_[k]);
    if (here > 0 && below + here >= wanted)
      return width * (static_cast<double>(k) + (wanted - below) / here);
    below += here;
  }
  return largest_;
}

}  // namespace axial::experiments
